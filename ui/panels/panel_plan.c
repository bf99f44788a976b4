/* Plan panel: decisions of the planner for the last picture, with reasons and costs. */
#include "ui/app/state/app_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panel_layer_plan.h"
#include "ui/panels/panels.h"
#include "ui/patch/patch.h"
#include "ui/patch/preview/preview.h"

#include "base/enum_rows.h"
#include "render/plan/plan.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Toggle of a row: the picture without the effect, or with it; a second press restores the plan. */
static void eye(WrApp *app, int effect, bool runs)
{
    WrPreviewLook *look = &app->patch->look;
    const bool forced = look->force && (int)look->effect == effect;
    wr_gui_push_id(effect);
    if (wr_gui_icon_button("eye", runs ? WR_ICON_EYE : WR_ICON_EYE_OFF, 18, forced)) {
        look->effect = (WrEffect)effect;
        look->force = forced ? WR_FORCE_NONE : runs ? WR_FORCE_OFF : WR_FORCE_ON;
    }
    wr_gui_pop_id();
    wr_gui_tip(forced ? "Restores the plan's choice"
               : runs ? "Switches it off to compare; another click switches it on again"
                      : "Switches it on to compare");
    wr_gui_same_line(6);
}

/* True if the picture can be rendered both ways. */
static bool has_eye(const WrPlanRow *row, const WrEffectInfo *info)
{
    return row->verdict != WR_VERDICT_NONE && !(row->run && info->only_way);
}

/* ---- rows that run, dearest first ---- */

static double seconds_of(const WrPlan *plan, int row)
{
    return row < WR_EFFECT_COUNT ? plan->rows[row].seconds : plan->cost[row - WR_EFFECT_COUNT];
}

/* True if the row belongs to the list of running effects. A toggled row stays in its list, under the pointer. */
static bool belongs(const WrApp *app, const WrPlan *plan, int row)
{
    const WrPreviewLook *look = &app->patch->look;
    if (row >= WR_EFFECT_COUNT) return plan->cost[row - WR_EFFECT_COUNT] > 0.0;
    return look->force && (int)look->effect == row ? look->force == WR_FORCE_OFF
                                                   : plan->rows[row].run;
}

/* Sorted anew by a picture at rest, or when other rows run: while pictures follow each other rows stay where they are. */
static void sort(const WrApp *app, const WrPreviewPicture *picture)
{
    WrLayerPlanState *state = app->layer_plan;
    const WrPlan *plan = &picture->plan;
    bool listed[WR_PLAN_ROWS] = { false }, same = true;
    for (int i = 0; i < state->ordered; i++) listed[state->order[i]] = true;
    for (int row = 0; row < WR_PLAN_ROWS; row++)
        same = same && listed[row] == belongs(app, plan, row);
    const bool forced = app->patch->look.force != WR_FORCE_NONE;
    if (same && (picture->level != WR_PREVIEW_FINAL || forced)) return;
    int kept = 0; /* while an effect is toggled its row stays under the pointer */
    for (int i = 0; forced && i < state->ordered; i++)
        if (belongs(app, plan, state->order[i])) state->order[kept++] = state->order[i];
    state->ordered = kept;
    for (int row = 0; row < WR_PLAN_ROWS; row++) {
        if (!belongs(app, plan, row) || (forced && listed[row])) continue;
        int at = state->ordered++;
        for (; at > kept && seconds_of(plan, state->order[at - 1]) < seconds_of(plan, row); at--)
            state->order[at] = state->order[at - 1];
        state->order[at] = row;
    }
}

/* ---- a row ---- */

static void name_of_row(const char *name, bool runs)
{
    const double room = wr_gui_available() - wr_gui_px(76); /* beside its time */
    const bool wide = wr_gui_text_width(WR_FONT_TEXT, wr_words(name)) > room;
    wr_gui_text(wide ? WR_FONT_SMALL : WR_FONT_TEXT, runs ? WR_COLOUR_STRONG : WR_COLOUR_MUTED,
                name);
}

/* Milliseconds of the picture, which its time by the clock is divided into as the threads' time is, and a bar. */
static void print_time(const WrPreviewPicture *picture, double seconds, double longest)
{
    char text[32];
    double stages[WR_PICTURE_STAGES];
    const double work = picture->plan.work;
    const double ms = work > 0.0 ? wr_picture_time(picture, stages) * seconds / work : 0.0;
    wr_words_print(text, sizeof text, ms < 0.1 ? "%.3f ms" : ms < 10.0 ? "%.2f ms" : "%.1f ms", ms);
    wr_gui_same_line(8);
    wr_gui_move_to(wr_gui_width() - wr_gui_text_width(WR_FONT_SMALL, text) - wr_gui_px(24));
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
    wr_gui_tip("Measured milliseconds of the newest picture");
    wr_gui_space(-4);
    wr_gui_bar(longest > 0.0 ? seconds / longest : 0.0);
}

/* The reason in the window's language; its start says whether the user toggled the effect. */
static const char *reason_words(const char *reason, char *out, size_t size)
{
    static const char *const starts[] = { "forced: ", "forced off: ", "" };
    int i = 0;
    while (strncmp(reason, starts[i], strlen(starts[i])) != 0) i++;
    snprintf(out, size, "%s%s", i < 2 ? wr_words(starts[i]) : "",
             wr_words(reason + strlen(starts[i])));
    return out;
}

static void effect_reason(const WrPlanRow *e)
{
    WR_ROWS(proofs);
    static const char *const proofs[] = { [WR_ROW(WR_PROOF_IDENTICAL)] = "same bits",
                                          [WR_ROW(WR_PROOF_BOUNDED)] = "bounded",
                                          [WR_ROW(WR_PROOF_POLICY)] = "by choice" };
    WR_ROWS_END(proofs, WR_PROOF_COUNT);
    char text[320], why[240];
    /* The proof applies to the planner's own decision, not to an effect that the user disabled. */
    if (e->run || e->verdict == WR_VERDICT_RUN) reason_words(e->reason, text, sizeof text);
    else
        snprintf(text, sizeof text, wr_words("%s: %s"), wr_words(proofs[e->proof]),
                 reason_words(e->reason, why, sizeof why));
    wr_gui_as_it_is(true); /* already translated */
    wr_gui_text_wrapped(WR_FONT_SMALL, e->run ? WR_COLOUR_LABEL : WR_COLOUR_FAINT, text);
    wr_gui_as_it_is(false);
    wr_gui_tip(e->rule);
}

static void row(WrApp *app, const WrPreviewPicture *picture, int i, double longest)
{
    const WrPlan *plan = &picture->plan;
    const double seconds = seconds_of(plan, i);
    const bool is_effect = i < WR_EFFECT_COUNT;
    const int cost = is_effect ? 0 : i - WR_EFFECT_COUNT;
    const bool runs = !is_effect || plan->rows[i].run;
    if (is_effect && has_eye(&plan->rows[i], &wr_effects[i])) eye(app, i, runs);
    name_of_row(is_effect ? plan->rows[i].name : wr_cost_names[cost], runs);
    if (runs && seconds > 0.0) print_time(picture, seconds, longest);
    else wr_gui_space(-6);
    if (is_effect) effect_reason(&plan->rows[i]);
    else wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, wr_cost_reasons[cost]);
    wr_gui_space(4);
}

void wr_panel_plan(WrApp *app)
{
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    const WrLayerPlanState *state = app->layer_plan;
    if (picture->serial == 0) {
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, "No picture yet.");
        return;
    }
    char words[WR_PICTURE_WORDS];
    wr_picture_words(picture, words);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, words);
    sort(app, picture);
    const double longest = seconds_of(&picture->plan, state->order[0]);
    if (wr_gui_fold("RUNS", true))
        for (int i = 0; i < state->ordered; i++) row(app, picture, state->order[i], longest);
    if (wr_gui_fold("LEFT OUT", false))
        for (int i = 0; i < WR_EFFECT_COUNT; i++)
            if (!belongs(app, &picture->plan, i)) row(app, picture, i, longest);
    wr_panel_layer_plan(app);
}
