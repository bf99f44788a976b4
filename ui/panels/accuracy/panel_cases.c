/* Hard-case gallery: requirement and measured deviation of each case, and the case itself on the patch. */
#include "ui/panels/accuracy/accuracy.h"
#include "ui/panels/accuracy/accuracy_work.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/search_score.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "accuracy/plot.h"
#include "hardcases/hardcases.h"
#include "base/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DIALOG_UNITS 900
#define ROW_UNITS 42

void wr_dialog_cases_open(WrApp *app)
{
    WrCases *cases = &app->accuracy->cases;
    cases->filter[0] = '\0';
    if (!cases->chosen) cases->chosen = wr_hardcase(0);
    if (!cases->report) cases->wanted = true;
    wr_dialog_open(app, WR_DIALOG_CASES);
    app->redraw = 8; /* until the field has the keyboard focus */
}

static const WrHardResult *result_of(const WrCases *cases, int index)
{
    return cases->report ? &cases->report->results[index] : NULL;
}

/* State of a row that was not measured: waiting or unavailable. */
static const char *verdict_of(const WrHardCase *row, const WrHardResult *result)
{
    if (result) return wr_hard_verdicts[result->verdict];
    return row->measure ? "" : wr_hard_verdicts[WR_HARD_WAITS];
}

static bool answers(const WrHardCase *row, const WrHardResult *result, const char *query)
{
    char text[900];
    snprintf(text, sizeof text, "%s %.200s %.400s %.60s %s %s", row->id, row->what, row->holds,
             wr_hard_subjects[row->subject], verdict_of(row, result),
             row->scene ? "open scene" : "");
    return wr_search_score(text, query) > 0;
}

/* ---- rows ---- */

static WrColour verdict_colour(const WrHardResult *result)
{
    if (!result) return WR_COLOUR_LABEL;
    return result->verdict == WR_HARD_PASS   ? WR_COLOUR_GOOD
           : result->verdict == WR_HARD_FAIL ? WR_COLOUR_BAD
                                             : WR_COLOUR_WARN;
}

static void right(double end, const char *text, WrColour colour)
{
    wr_gui_row_set_cursor(end - wr_gui_text_width(WR_FONT_SMALL, text), 0);
    wr_gui_text(WR_FONT_SMALL, colour, text);
}

static void worst(double end, const WrHardCase *row, const WrHardResult *result, WrHardPrecision p)
{
    char text[16];
    if (!result || isnan(row->bound[p]) || isnan(result->worst[p])) {
        right(end, "\xe2\x80\x93", WR_COLOUR_FAINT);
        return;
    }
    right(end, wr_plot_number(result->worst[p], text),
          result->worst[p] <= row->bound[p] ? WR_COLOUR_TEXT : WR_COLOUR_BAD);
}

/* Right ends of the columns as fractions of the row. */
#define END_FLOAT 0.69
#define END_DOUBLE 0.79
#define END_UNIT 0.805
#define END_VERDICT 0.985

static void head(void)
{
    static const struct {
        const char *text;
        double at;
        bool ends;
    } columns[] = { { "case, and required result", 0.012, false },
                    { "worst in float", END_FLOAT, true },
                    { "in double", END_DOUBLE, true },
                    { "unit", END_UNIT, false },
                    { "verdict", END_VERDICT, true } };
    wr_gui_row_begin(-1, 22, false);
    /* As wide as the list below, whose scroll bar is inside it. */
    const double left = wr_gui_px(20), wide = wr_gui_row_width() - 2 * left - wr_gui_px(10);
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) {
        const double x = left + columns[i].at * wide;
        wr_gui_row_set_cursor(
            columns[i].ends ? x - wr_gui_text_width(WR_FONT_SMALL, columns[i].text) : x, 0);
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, columns[i].text);
    }
    wr_gui_row_end();
}

static WrRow row_of(const WrCases *cases, int index)
{
    const WrHardCase *row = wr_hardcase(index);
    const WrHardResult *result = result_of(cases, index);
    WrRow r = wr_gui_row_begin(index, ROW_UNITS, row == cases->chosen);
    const double wide = wr_gui_row_width(), x = 0.012 * wide,
                 line = wr_gui_line_height(WR_FONT_TEXT);
    const double text = x + wr_gui_px(52), room = (END_FLOAT - 0.09) * wide - text;
    wr_gui_row_set_cursor(x, 2.3 * line);
    wr_gui_as_it_is(true);
    wr_gui_text(WR_FONT_SMALL, row->scene ? WR_COLOUR_ACCENT : WR_COLOUR_LABEL, row->id);
    wr_gui_row_set_cursor(text, 2.3 * line);
    wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_STRONG, row->what, room);
    wr_gui_row_set_cursor(text, 0.2 * line);
    wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_LABEL, row->holds, room);
    wr_gui_as_it_is(false);
    worst(END_FLOAT * wide, row, result, WR_HARD_FLOAT);
    worst(END_DOUBLE * wide, row, result, WR_HARD_DOUBLE);
    wr_gui_row_set_cursor(END_UNIT * wide, 0);
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_MUTED, row->unit, 0.1 * wide);
    wr_gui_as_it_is(false);
    right(END_VERDICT * wide, verdict_of(row, result), verdict_colour(result));
    wr_gui_row_end();
    return r;
}

/* ---- below the list ---- */

static void bound_words(const WrHardCase *row, WrText *text)
{
    char number[16];
    static const char *const names[] = { "float", "double" };
    for (int p = 0; p < WR_HARD_PRECISIONS; p++)
        if (!isnan(row->bound[p]))
            wr_text_addf(text, "%s%s %s", text->length ? ", " : "Bound: ", names[p],
                         wr_plot_number(row->bound[p], number));
    if (text->length) wr_text_addf(text, " %s.", row->unit);
}

static void detail(const WrCases *cases)
{
    const WrHardCase *row = cases->chosen;
    WrText text = { 0 };
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardResult *result = result_of(cases, i);
        if (wr_hardcase(i) != row || !result || !result->note[0]) continue;
        wr_text_addf(&text, "%s. ", result->note);
    }
    WrText bound = { 0 };
    bound_words(row, &bound);
    wr_text_addf(&text, "%s%s%s", wr_text_get(&bound), row->waits ? " Waits for: " : "",
                 row->waits ? row->waits : "");
    wr_gui_list_begin("detail", wr_gui_px(112));
    wr_gui_as_it_is(true);
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, row->holds);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, wr_text_get(&text));
    wr_gui_as_it_is(false);
    wr_text_clear(&text);
    for (const char *c = row->scene ? row->scene : "It cannot be shown on a patch."; *c; c++)
        wr_text_add_n(&text, *c == '\n' ? "  \xc2\xb7  " : c, *c == '\n' ? 6 : 1);
    wr_gui_as_it_is(true);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_MUTED, wr_text_get(&text));
    wr_gui_as_it_is(false);
    wr_gui_list_end();
    wr_text_fini(&bound);
    wr_text_fini(&text);
}

static void counts(const WrCases *cases, int shown)
{
    char text[160];
    int used = snprintf(text, sizeof text, wr_words("%d of %d"), shown, WR_HARDCASES);
    if (cases->report)
        for (int v = 0; v < WR_HARD_VERDICTS; v++)
            if (cases->report->count[v] > 0)
                used += snprintf(text + used, sizeof text - (size_t)used, "  \xc2\xb7  %d %s",
                                 cases->report->count[v], wr_hard_verdicts[v]);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
}

static void measuring(WrApp *app)
{
    double fraction = 0;
    bool runs = wr_accuracy_busy(app, WR_WORK_CASES, &fraction);
    if (runs || app->accuracy->cases.wanted) {
        wr_gui_progress(wr_gui_px(200), runs ? fraction : -1.0);
        wr_gui_same_line(8);
    } else {
        if (wr_gui_button("Measure again", false)) app->accuracy->cases.wanted = true;
        wr_gui_same_line(8);
    }
}

/* ---- the dialog ---- */

void wr_dialog_cases(WrApp *app)
{
    WrCases *cases = &app->accuracy->cases;
    if (!wr_gui_dialog_begin("Hard cases", DIALOG_UNITS)) return;
    int shown = 0;
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, WR_ICON_SEARCH);
    wr_gui_same_line(8);
    bool open =
        wr_gui_text_field("##cases", 0, cases->filter, sizeof cases->filter, app->dialog->fresh);
    wr_gui_tip(
        "Search words: of the case, its subject, its result; \"open\" for those with a picture");
    head();
    wr_gui_list_begin("cases", fmax(wr_gui_px(140), app->height - wr_gui_px(350)));
    wr_gui_space(-8);
    const WrHardCase *first = NULL;
    bool among = false;
    for (int i = 0; i < WR_HARDCASES; i++) {
        if (!answers(wr_hardcase(i), result_of(cases, i), cases->filter)) continue;
        if (shown++ == 0) first = wr_hardcase(i);
        among |= wr_hardcase(i) == cases->chosen;
        WrRow r = row_of(cases, i);
        if (r.clicked || r.doubled) cases->chosen = wr_hardcase(i);
        open |= r.doubled;
    }
    if (shown == 0) wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, "None has these words.");
    wr_gui_list_end();
    if (!among && first) cases->chosen = first; /* the row for Return must be visible */
    detail(cases);
    bool scene = cases->chosen->scene != NULL;
    wr_gui_disable(!scene);
    open |=
        wr_gui_button("Open", true) || (scene && !app->dialog->fresh && wr_gui_return_pressed());
    wr_gui_disable_end();
    wr_gui_tip(scene ? "As a new document" : "It cannot be shown on a patch");
    wr_gui_same_line(8);
    bool close = wr_gui_button("Close", false) || (!app->dialog->fresh && wr_gui_escape_pressed());
    wr_gui_same_line(16);
    measuring(app);
    counts(cases, shown);
    if (open && scene) {
        wr_dialog_close(app);
        wr_app_open_lines(app, cases->chosen->scene);
    } else if (close) {
        wr_dialog_close(app);
    }
    wr_gui_dialog_end();
}
