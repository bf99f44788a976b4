/* Error of bump mapping against displacement, in the Accuracy tab: numbers for the view at the time of the request,
   and their interpretation. */
#include "ui/panels/accuracy/accuracy.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/app/jobs/job.h"

#include "accuracy/plot.h"
#include "accuracy/illusion.h"
#include "base/text.h"

static void line(const char *name, double value, const char *unit, const char *tip)
{
    char number[16], text[32];
    snprintf(text, sizeof text, "%s%s", wr_plot_number(value, number), unit);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, name);
    wr_gui_tip(tip);
    wr_gui_same_line(0);
    wr_gui_move_to(wr_gui_place() + wr_gui_available() - wr_gui_text_width(WR_FONT_SMALL, text));
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_STRONG, text);
    wr_gui_tip(tip);
    wr_gui_space(-7);
}

static void results(const WrWork *work, bool old)
{
    const WrIllusion *it = &work->illusion;
    WrText advice = { 0 };
    line("outline, mean", it->outline_mean, " px",
         "Area between the outlines of the bumped and the displaced picture, divided by their "
         "length");
    line("outline, farthest", it->hausdorff, " px",
         "Largest distance of a point of one outline to the other (Hausdorff)");
    line("shading", it->shading, "",
         "Root mean square of the displaced picture without shadows minus the bumped one, where "
         "both cover the pixel");
    line("at the same u, v", it->shading_at, "",
         "The same compared at each point of the surface, not of the picture: the effect of the "
         "normal alone");
    line("shadow", it->shadow, "",
         "Root mean square of the displaced picture with shadows minus that without");
    line("places moved", it->way_mean, " px",
         "Distance between the true position of a point and its position with bump mapping");
    wr_gui_space(8);
    wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_CELL, /* its space is kept */
                    old ? "For the previous view; measure again." : " ", wr_gui_available());
    wr_illusion_advice(it, &advice);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, wr_text_get(&advice));
    wr_text_fini(&advice);
}

void wr_panel_illusion(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    double fraction = 0;
    if (!wr_gui_fold("BUMP BESIDE DISPLACEMENT", false)) return;
    if (a->illusion) results(a->illusion, a->illusion->of != a->state);
    if (wr_accuracy_busy(app, WR_WORK_ILLUSION, &fraction)) {
        wr_gui_progress(wr_gui_available() - wr_gui_px(64), fraction);
        wr_gui_same_line(8);
        if (wr_gui_chip(NULL, "Stop##illusion")) wr_job_interrupt(a->measure);
        return;
    }
    if (wr_gui_button("Compare", false)) {
        app->settings->turning = false;
        a->illusion_wanted = true;
    }
    wr_gui_tip("Renders this view bump mapped, displaced, and displaced with shadows, and reports "
               "their differences: outline, shading and shadow.");
    if (a->illusion) {
        wr_gui_same_line(8);
        const bool shown = a->look == WR_PATCH_LACKS;
        wr_gui_next_id("map");
        if (wr_gui_button(shown ? "Picture" : "Map on the patch", false))
            wr_accuracy_set_view(app, shown ? WR_PATCH_PLAIN : WR_PATCH_LACKS);
        wr_gui_tip("Shows the differences from bump mapping over the patch: outline red, shading "
                   "green, shadow blue");
    }
}
