/* Dialogs that change the selection by numbers; the canvas shows the resulting outline. */
#include "ui/canvas/outline.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/line.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/panels/panels.h"
#include "ui/canvas/overlays/marks.h"

#include "base/enum_rows.h"
#include "base/text.h"
#include "document/document.h"
#include "field/field.h"
#include "field/select.h"

WR_ROWS(kinds);
static const struct {
    const char *title, *help, *verb;
} kinds[WR_OUTLINE_KINDS] = {
    [WR_ROW(WR_OUTLINE_PRESENT)] = { NULL, NULL, NULL }, /* not requested */
    [WR_ROW(WR_OUTLINE_GROW)] = { "Grow the selection", "Moves its edge outwards.", "grow" },
    [WR_ROW(WR_OUTLINE_SHRINK)] = { "Shrink the selection", "Moves its edge inwards.", "shrink" },
    [WR_ROW(
        WR_OUTLINE_FEATHER)] = { "Feather the selection",
                                 "Blurs its edge. The outline is drawn at a selection of one half.",
                                 "feather" },
    [WR_ROW(WR_OUTLINE_HEIGHT)] = { "Select by height",
                                    "Selects everything in this range of heights.", "height" },
    [WR_ROW(WR_OUTLINE_SLOPE)] = { "Select by slope",
                                   "Selects everything in this range of slopes, at the scene's "
                                   "bump height.",
                                   "slope" },
};
WR_ROWS_END(kinds, WR_OUTLINE_KINDS);

static bool ranged(const WrApp *app)
{
    return app->selecting->kind == WR_OUTLINE_HEIGHT || app->selecting->kind == WR_OUTLINE_SLOPE;
}

void wr_dialog_select_open(WrApp *app, WrOutlineKind kind)
{
    wr_dialog_open(app, WR_DIALOG_SELECT);
    *app->selecting =
        (WrOutlineRequest){ .kind = kind, .by = 4.0, .mode = (WrSelectMode)app->settings->join };
    if (kind == WR_OUTLINE_HEIGHT) {
        float low, high;
        wr_field_range(wr_app_field(app), &low, &high);
        app->selecting->low = wr_line_round(((double)low + (double)high) / 2.0, 3);
        app->selecting->high = wr_line_round((double)high + 0.0005, 3);
    } else if (kind == WR_OUTLINE_SLOPE) {
        app->selecting->low = 20.0;
        app->selecting->high = 90.0;
    }
    wr_marks_try(app, app->selecting);
}

static bool number(const char *label, double low, double high, double hard_low, double hard_high,
                   double reset, const char *unit, const char *tip, double *value)
{
    WrNumber spec = { .low = low,
                      .high = high,
                      .hard_low = hard_low,
                      .hard_high = hard_high,
                      .reset = reset,
                      .decimals = hard_high == 90.0 || unit ? 1 : 3,
                      .unit = unit,
                      .tip = tip };
    wr_gui_label(label);
    return wr_gui_number(label, 0, &spec, value) != WR_EDIT_NONE;
}

static bool range_fields(WrApp *app)
{
    WR_ROWS(joins);
    static const char *const joins[WR_SELECT_MODES] = {
        [WR_ROW(WR_SELECT_REPLACE)] = "Replace the selection",
        [WR_ROW(WR_SELECT_ADD)] = "Add to it",
        [WR_ROW(WR_SELECT_SUBTRACT)] = "Take from it",
        [WR_ROW(WR_SELECT_INTERSECT)] = "Intersect with it",
    };
    WR_ROWS_END(joins, WR_SELECT_MODES);
    WrOutlineRequest *a = app->selecting;
    bool changed = false, slope = a->kind == WR_OUTLINE_SLOPE;
    double low = slope ? 0.0 : app->selecting->low < 0.0 ? -1.0 : 0.0, high = slope ? 90.0 : 1.0;
    double least = slope ? 0.0 : -1e30, most = slope ? 90.0 : 1e30;
    const char *unit = slope ? "\xc2\xb0" : NULL;
    changed |= number("From", low, high, least, most, 0, unit, "The lower end", &a->low);
    changed |= number("To", low, high, least, most, high, unit, "The upper end", &a->high);
    changed |= number("Softness", 0, slope ? 30.0 : 0.5, 0, most, 0, unit,
                      "Width of the fade beyond both ends", &a->soft);
    if (a->low > a->high) a->high = a->low;
    int mode = (int)a->mode;
    if (a->to_mask) return changed;
    wr_gui_label("How");
    if (wr_gui_choice("join", 0, joins, WR_SELECT_MODES, &mode)) {
        a->mode = (WrSelectMode)mode;
        changed = true;
    }
    return changed;
}

static void commit(WrApp *app)
{
    const WrOutlineRequest *a = app->selecting;
    WrText line = { 0 };
    if (a->to_mask)
        wr_text_addf(&line, "layer mask %d from=%s", wr_app_document(app)->active + 1,
                     kinds[a->kind].verb);
    else wr_text_addf(&line, "select %s", kinds[a->kind].verb);
    if (ranged(app)) {
        wr_line_number(&line, "low", a->low);
        wr_line_number(&line, "high", a->high);
        if (a->soft > 0.0) wr_line_number(&line, "soft", a->soft);
        if (a->mode != WR_SELECT_REPLACE && !a->to_mask)
            wr_text_addf(&line, " mode=%s", wr_select_modes[a->mode]);
    } else {
        wr_line_number(&line, "by", a->by);
    }
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

void wr_dialog_select(WrApp *app)
{
    WrOutlineKind kind = app->selecting->kind;
    bool mask = app->selecting->to_mask;
    const char *title = !mask                       ? kinds[kind].title
                        : kind == WR_OUTLINE_HEIGHT ? "Mask by height"
                                                    : "Mask by slope";
    if (!wr_gui_dialog_begin_at(title, wr_dialog_side(app))) return;
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, kinds[kind].help);
    wr_gui_space(4);
    bool feather = kind == WR_OUTLINE_FEATHER;
    bool changed =
        ranged(app)
            ? range_fields(app)
            : number(feather ? "Width" : "By", 0, 64, 0, feather ? 1024 : WR_FIELD_MAX, 4, "texels",
                     feather ? "Standard deviation of the blur" : "How far", &app->selecting->by);
    if (changed) wr_marks_try(app, app->selecting);
    int answer = wr_dialog_buttons(app, mask ? "Make mask" : "Select", true);
    if (answer > 0) commit(app);
    if (answer != 0) wr_marks_try(app, NULL);
    wr_gui_dialog_end();
}
