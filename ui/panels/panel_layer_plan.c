#include "ui/panels/panel_layer_plan.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "command/session.h"
#include "document/layer_times.h"

#include <stdio.h>

/* Counting the tiles costs some milliseconds, so the plan is made once for each step, and not while a preview makes layers. */
static const WrLayerPlan *plan_of(WrApp *app)
{
    WrLayerPlanState *state = app->layer_plan;
    const uint64_t revision = wr_session_revision(app->session) + 1;
    const uint64_t making = app->trying ? state->making : wr_layer_time_last();
    if (state->revision == revision && state->making == making) return state->plan;
    wr_session_layer_plan(app->session, state->plan);
    state->revision = revision;
    state->making = making;
    return state->plan;
}

static void print_cost(const WrLayerPlan *plan, char *text, size_t size)
{
    const double mb = 1e-6 * (double)plan->bytes;
    if (plan->seconds >= 1.0)
        wr_words_print(text, size, wr_words("%.2f s  %.1f MB"), plan->seconds, mb);
    else if (plan->seconds > 0.0)
        wr_words_print(text, size, wr_words("%.3g ms  %.1f MB"), 1e3 * plan->seconds, mb);
    else wr_words_print(text, size, wr_words("%.1f MB"), mb);
}

static void row(const WrLayer *layer, const WrLayerPlan *plan, double longest)
{
    char text[64], reason[WR_WORDS_MESSAGE], line[WR_WORDS_MESSAGE + 64];
    print_cost(plan, text, sizeof text);
    const double right = wr_gui_width() - wr_gui_text_width(WR_FONT_SMALL, text) - wr_gui_px(24);
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_TEXT,
                    plan->run == WR_LAYER_SKIPPED ? WR_COLOUR_MUTED : WR_COLOUR_STRONG, layer->name,
                    right - wr_gui_px(8));
    wr_gui_same_line(8);
    wr_gui_move_to(right);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
    wr_gui_as_it_is(false);
    wr_gui_tip("Time of its last computation, and memory that no other layer shares");
    wr_gui_space(-4);
    if (plan->seconds > 0.0) wr_gui_bar(plan->seconds / longest);
    const char *run = plan->run == WR_LAYER_EVALUATED ? wr_words("evaluated")
                      : plan->run == WR_LAYER_REUSED  ? wr_words("reused")
                                                      : wr_words("skipped");
    snprintf(line, sizeof line, "%s: %s", run,
             wr_words_message(plan->message, reason, sizeof reason));
    wr_gui_text_wrapped(WR_FONT_SMALL,
                        plan->run == WR_LAYER_EVALUATED ? WR_COLOUR_LABEL : WR_COLOUR_FAINT, line);
    wr_gui_space(4);
}

void wr_panel_layer_plan(WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const WrLayerPlan *plan = plan_of(app);
    if (!wr_gui_fold("LAYERS, AT THE LAST EDIT", true)) return;
    wr_gui_space(2);
    /* Dearest first, among equal ones the upper. */
    int order[WR_LAYERS_MAX], count = 0;
    for (int i = document->layer_count - 1; i >= 0; i--) {
        int at = count++;
        for (; at > 0 && plan[order[at - 1]].seconds < plan[i].seconds; at--)
            order[at] = order[at - 1];
        order[at] = i;
    }
    for (int i = 0; i < count; i++)
        row(&document->layers[order[i]], &plan[order[i]], plan[order[0]].seconds);
    wr_gui_space(8);
}
