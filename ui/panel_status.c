/* SPDX-License-Identifier: MIT
   The status line: what is under the pointer, what the last picture cost, what there is to say. */
#include "ui/state.h"

#include "base/clock.h"
#include "base/exactmath.h"

#include <math.h>

#define NOTE_SECONDS 6.0

static void pair(const char *name, const char *value)
{
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, name);
    wr_gui_same_line(4);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_TEXT, value);
    wr_gui_same_line(14);
}

/* u, v, F and slope at the pointer, on the canvas or on the patch. */
static void under_pointer(const WrApp *app)
{
    double u, v, f, fu, fv;
    const WrScene *scene = wr_app_scene(app);
    char text[48];
    if (app->hand.on_canvas) {
        u = app->hand.at.u - floor(app->hand.at.u);
        v = app->hand.at.v - floor(app->hand.at.v);
    } else if (app->hand.on_patch && wr_preview_point_hit(app->preview, &u, &v)) {
        u = wr_field_reduce(u, scene->replicate_u);
        v = wr_field_reduce(v, scene->replicate_v);
    } else {
        return;
    }
    wr_field_sample(wr_app_field(app), scene->scheme, 1, &u, &v, &f, &fu, &fv);
    double slope = hypot(fu, fv) * fabs(scene->height);
    snprintf(text, sizeof text, "%.3f", u);
    pair("u", text);
    snprintf(text, sizeof text, "%.3f", v);
    pair("v", text);
    snprintf(text, sizeof text, "%.4g", f);
    pair("F", text);
    snprintf(text, sizeof text, "%.1f\xc2\xb0", wr_atan2(slope, 1.0) / WR_RAD_PER_DEG);
    pair("slope", text);
    wr_gui_tip("Angle of the relief over the unit cell at the scene's bump height");
}

static void dismiss(WrApp *app)
{
    app->messages.unread = 0;
    wr_app_redraw(app);
}

static void all_messages(WrApp *app)
{
    const WrMessages *m = &app->messages;
    if (!wr_gui_popup_begin("messages")) return;
    wr_gui_heading("MESSAGES");
    for (int i = m->list.count - 1; i >= 0 && i >= m->list.count - 12; i--) {
        char line[128];
        snprintf(line, sizeof line, "%.124s", m->list.data[i].text);
        wr_gui_text(WR_FONT_TEXT, m->list.data[i].bad ? WR_COLOUR_BAD : WR_COLOUR_TEXT, line);
        wr_gui_tip(m->list.data[i].text);
    }
    wr_gui_popup_end();
}

/* The newest error that was not read, else a note that is still young. False if there is nothing. */
static bool message(WrApp *app)
{
    const WrMessages *m = &app->messages;
    const WrMessage *show = NULL;
    for (int i = m->list.count - 1; i >= 0 && !show && m->unread > 0; i--)
        if (m->list.data[i].bad) show = &m->list.data[i];
    const WrMessage *last = m->list.count ? &m->list.data[m->list.count - 1] : NULL;
    if (!show && last && !last->bad && wr_clock_seconds() - last->since < NOTE_SECONDS) show = last;
    if (!show) return false;
    if (show->bad) {
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_BAD, WR_ICON_ALERT);
        wr_gui_same_line(6);
        if (wr_gui_chip(NULL, "Dismiss")) dismiss(app);
        wr_gui_same_line(6);
        if (wr_gui_chip(NULL, "All")) wr_gui_popup_open("messages");
        all_messages(app);
        wr_gui_same_line(8);
    }
    wr_gui_text(WR_FONT_TEXT, show->bad ? WR_COLOUR_STRONG : WR_COLOUR_TEXT, show->text);
    wr_gui_tip(show->text);
    return true;
}

/* Where the picture's time went, in percent: the stages work on several threads at once. */
static int stages(const WrStageTimes *t, char *text, size_t size, int used)
{
    double all = t->visibility + t->geometry + t->bump + t->shade + t->resolve;
    if (all <= 0) return used;
    return used + snprintf(text + used, size - (size_t)used,
                           "visibility %.0f %%  geometry %.0f %%  bump %.0f %%  shade %.0f %%     ",
                           100 * t->visibility / all, 100 * t->geometry / all, 100 * t->bump / all,
                           100 * t->shade / all);
}

static void right_side(const WrApp *app)
{
    const WrPreviewPicture *p = wr_preview_picture(app->preview);
    const WrField *field = wr_app_field(app);
    char text[300];
    int used = 0;
    if (p->serial) {
        used = snprintf(text, sizeof text, "%s  \xc2\xb7  %.1f ms     ",
                        wr_surfaces[wr_app_scene(app)->shape.kind]->label, p->seconds * 1e3);
        if (app->layout.status.w > wr_gui_px(1200))
            used = stages(&p->times, text, sizeof text, used);
    }
    double bytes = (double)wr_field_bytes(field);
    snprintf(text + used, sizeof text - (size_t)used, "%d \xc3\x97 %d  \xc2\xb7  %.3g MB     %s",
             wr_field_width(field), wr_field_height(field), bytes / 1048576.0,
             wr_app_unsaved(app)                ? "not saved"
             : wr_session_path(app->session)[0] ? "saved"
                                                : "no changes");
    double width = wr_gui_text_width(WR_FONT_TEXT, text);
    wr_gui_move_to(wr_gui_width() - width - wr_gui_px(12));
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, text);
    if (!p->serial) return;
    char tip[300];
    const WrStageTimes *t = &p->times;
    snprintf(tip, sizeof tip,
             "Last picture, %d x %d pixels, milliseconds by stage (all threads)\n"
             "prepare %.2f\nvisibility %.2f\ngeometry %.2f\nbump %.2f\nshade %.2f\nresolve %.2f",
             p->width, p->height, t->prepare * 1e3, t->visibility * 1e3, t->geometry * 1e3,
             t->bump * 1e3, t->shade * 1e3, t->resolve * 1e3);
    wr_gui_tip(tip);
}

void wr_panel_status(WrApp *app)
{
    if (app->layout.status.w <= 0) return;
    wr_gui_area_begin("##status", WR_AREA_BAR, app->layout.status, WR_COLOUR_BAR);
    if (!message(app)) {
        char text[32];
        under_pointer(app);
        snprintf(text, sizeof text, app->view.zoom < 0.1 ? "%.1f %%" : "%.0f %%",
                 app->view.zoom * 100.0);
        pair("zoom", text);
        right_side(app);
    }
    wr_gui_area_end();
}
