/* Status line: values under the pointer, the tool's hint, messages; times and memory if they are asked for. */
#include "ui/panels/panel_status.h"
#include "ui/canvas/outline.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panel_adjust.h"
#include "ui/panels/panel_sheet.h"
#include "ui/patch/preview/preview.h"
#include "ui/canvas/overlays/marks.h"
#include "ui/canvas/tools/tool.h"
#include "ui/app/jobs/edit_preview.h"

#include "base/exactmath.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "field/scheme.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "system/clock.h"
#include "system/process.h"

#include "base/enum_rows.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define METER_SECONDS 2.0
#define MOMENT_SECONDS 0.2 /* shorter work shows no progress */

static void pair(const char *name, const char *value)
{
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, name);
    wr_gui_same_line(4);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_TEXT, value);
    wr_gui_same_line(14);
}

/* u, v, F and slope under the pointer, on the canvas or on the patch. */
static void under_pointer(const WrApp *app)
{
    double u, v, f, fu, fv;
    const WrScene *scene = wr_app_scene(app);
    char text[48];
    if (app->hand->on_canvas) {
        u = app->hand->at.u - floor(app->hand->at.u);
        v = app->hand->at.v - floor(app->hand->at.v);
    } else if (app->hand->on_patch && wr_preview_point_hit(app->preview, &u, &v)) {
        u = wr_field_reduce(u, scene->replicate_u);
        v = wr_field_reduce(v, scene->replicate_v);
    } else {
        return;
    }
    wr_field_sample(wr_app_canvas_field(app), scene->scheme, 1, &u, &v, &f, &fu, &fv);
    double slope = hypot(fu, fv) * fabs(scene->height);
    wr_words_print(text, sizeof text, "%.3f", u);
    pair("u", text);
    wr_words_print(text, sizeof text, "%.3f", v);
    pair("v", text);
    wr_words_print(text, sizeof text, "%.4g", f);
    pair("F", text);
    wr_gui_tip("Height in the table; F in the inspector is this times the bump height");
    wr_words_print(text, sizeof text, "%.1f\xc2\xb0", wr_atan2(slope, 1.0) / WR_RAD_PER_DEG);
    pair("slope", text);
    wr_gui_tip("Angle of the relief over the unit cell at the scene's bump height");
}

static void dismiss(WrApp *app)
{
    app->messages->unread = 0;
    wr_app_redraw(app);
}

/* Wrap a text at about that many letters per line. */
#define LINE_LETTERS 96

static void in_lines(WrColour colour, const char *text)
{
    while (*text) {
        char line[LINE_LETTERS + 64];
        size_t length = strcspn(text, "\n");
        if (length > LINE_LETTERS) {
            length = LINE_LETTERS;
            while (length > LINE_LETTERS / 2 && text[length] != ' ') length--;
            while ((text[length] & 0xc0) == 0x80) length--; /* at a character boundary */
        }
        snprintf(line, sizeof line, "%.*s", (int)length, text);
        wr_gui_text(WR_FONT_TEXT, colour, line);
        text += length;
        while (*text == ' ' || *text == '\n') text++;
    }
}

static void all_messages(const WrApp *app)
{
    const WrMessages *m = app->messages;
    if (!wr_gui_popup_begin("messages")) return;
    wr_gui_heading("MESSAGES");
    for (int i = m->list.count - 1; i >= 0 && i >= m->list.count - 12; i--) {
        wr_gui_as_it_is(true); /* already translated */
        in_lines(m->list.data[i].bad ? WR_COLOUR_BAD : WR_COLOUR_TEXT, m->list.data[i].text);
        wr_gui_as_it_is(false);
        wr_gui_space(2);
    }
    wr_gui_popup_end();
}

/* Number of unread errors; a click shows them all. */
static void unread_errors(WrApp *app)
{
    char count[32];
    snprintf(count, sizeof count,
             app->messages->unread == 1 ? wr_words("%d error") : wr_words("%d errors"),
             app->messages->unread);
    wr_gui_next_id("errors");
    if (wr_gui_chip(WR_ICON_ALERT, count)) {
        wr_gui_popup_open("messages");
        dismiss(app);
    }
    wr_gui_tip("Unread errors");
    wr_gui_same_line(8);
}

/* The action of a message's button; NULL: none, or it cannot run now. A new mask is offered only without one. */
static const WrAction *help_action(const WrApp *app, const WrMessage *message, int i)
{
    const WrAction *action = message->actions[i] ? wr_action_find(app, message->actions[i]) : NULL;
    if (!action || !wr_action_can(app, action)) return NULL;
    const bool makes = strcmp(action->name, WR_ACT(mask_white)) == 0;
    return makes && help_action(app, message, 0) ? NULL : action;
}

typedef struct HelpButton {
    const WrAction *action; /* NULL: the message's command */
    const char *label;
} HelpButton;

/* The buttons beside a message: one, and more while the text, `wide` pixels, is shown whole. room: pixels for text and buttons;
   becomes the rest for the text. Returns their number. */
static int help_list(const WrApp *app, const WrMessage *message, double wide, double *room,
                     HelpButton out[WR_PLAIN_ACTIONS + 1])
{
    int count = 0;
    for (int i = -1; i < WR_PLAIN_ACTIONS; i++) {
        const WrAction *action = i >= 0 ? help_action(app, message, i) : NULL;
        const char *label = i < 0 ? message->remedy.label : action ? action->label : NULL;
        if (!label) continue;
        const double width = wr_gui_text_width(WR_FONT_TEXT, label) + wr_gui_px(30);
        if (*room - width < (count > 0 ? wide : wr_gui_px(120))) break;
        *room -= width;
        out[count++] = (HelpButton){ action, label };
    }
    return count;
}

static void help_buttons(WrApp *app, const WrMessage *message, const HelpButton *buttons, int count)
{
    const WrRemedy remedy = message->remedy;
    int chosen = -1;
    for (int i = 0; i < count; i++) {
        wr_gui_same_line(8);
        if (wr_gui_chip(NULL, buttons[i].label)) chosen = i;
        if (buttons[i].action) wr_gui_tip(wr_action_help(app, buttons[i].action));
    }
    if (chosen < 0) return;
    dismiss(app);
    if (buttons[chosen].action) wr_action_run(app, buttons[chosen].action->name);
    else wr_app_run_slow(app, remedy.line);
}

/* The newest message: an unread error (until something newer succeeds) or a recent note, beside the values under the
   pointer. A click shows the full text. Earlier errors are counted. False if the rest of the line is free. */
static bool message(WrApp *app, double from)
{
    const WrMessage *show = wr_messages_shown(app->messages, wr_clock_seconds());
    bool error = show && show->bad;
    if (!show && app->messages->unread == 0) {
        all_messages(app); /* the list may be open */
        return false;
    }
    wr_gui_move_to(from);
    if (error) {
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_BAD, WR_ICON_ALERT);
        wr_gui_same_line(6);
    } else if (app->messages->unread > 0) {
        unread_errors(app);
    }
    all_messages(app);
    if (!show) return false;
    HelpButton buttons[WR_PLAIN_ACTIONS + 1];
    wr_gui_as_it_is(true);
    const double wide = wr_gui_text_width(WR_FONT_TEXT, show->text);
    wr_gui_as_it_is(false);
    double room = wr_gui_width() - wr_gui_place() - wr_gui_px(error ? 190 : 12);
    const int count = help_list(app, show, wide, &room, buttons);
    const bool cut = wide > room;
    if (cut && !error) room -= wr_gui_px(88);
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_TEXT, error ? WR_COLOUR_STRONG : WR_COLOUR_TEXT, show->text, room);
    wr_gui_tip(show->text);
    wr_gui_as_it_is(false);
    help_buttons(app, show, buttons, count);
    if (!error && !cut) return true;
    wr_gui_same_line(8);
    if (wr_gui_chip(NULL, "Details")) wr_gui_popup_open("messages");
    if (!error) return true;
    wr_gui_same_line(6);
    if (wr_gui_chip(NULL, "Dismiss")) dismiss(app);
    return true;
}

/* Distribution of the picture's time in percent. */
static int stages(const double ms[WR_PICTURE_STAGES], double all, char *text, size_t size, int used)
{
    for (int i = 1; i < WR_PICTURE_STAGES && all > 0.0; i++)
        used += snprintf(text + used, size - (size_t)used, "%s %.0f %%%s",
                         wr_words(wr_picture_stages[i]), 100.0 * ms[i] / all,
                         i + 1 < WR_PICTURE_STAGES ? "  " : "     ");
    return used;
}

/* ---- memory ---- */

static double layer_bytes(const WrLayer *layer)
{
    double bytes = (double)wr_field_bytes(layer->heights);
    if (layer->cover) bytes += (double)wr_field_bytes(layer->cover);
    return layer->mask ? bytes + (double)wr_field_bytes(layer->mask) : bytes;
}

/* Measured at intervals, since counting the tiles of a large table needs a moment. */
static void measure(WrApp *app)
{
    WrMeter *meter = app->meter;
    double now = wr_clock_seconds();
    const WrDocument *document = wr_app_document(app);
    if (meter->at > 0.0 && now - meter->at < METER_SECONDS) return;
    meter->at = now;
    meter->tiles = document->selection ? (double)wr_field_bytes(document->selection) : 0.0;
    for (int i = 0; i < document->layer_count; i++)
        meter->tiles += layer_bytes(&document->layers[i]);
    meter->undo = (double)wr_session_history_bytes(app->session);
    meter->all = (double)wr_process_resident();
}

static void memory(WrApp *app)
{
    const WrMeter *m = app->meter;
    char text[48], tip[200];
    measure(app);
    wr_words_print(text, sizeof text, wr_words("%.3g MB"), m->all / 1e6);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, text);
    double rest = m->all - m->tiles - m->undo;
    wr_words_print(
        tip, sizeof tip,
        wr_words(
            "Memory\nlayers and selection %.3g MB\nundo %.3g MB\npictures, caches and the program "
            "%.3g MB"),
        m->tiles / 1e6, m->undo / 1e6, rest > 0.0 ? rest / 1e6 : 0.0);
    wr_gui_tip(tip);
}

/* ---- right end ---- */

static void picture(const WrApp *app, bool with_stages, char *text, size_t size)
{
    const WrPreviewPicture *p = wr_preview_picture(app->preview);
    double ms[WR_PICTURE_STAGES], all = wr_picture_time(p, ms);
    text[0] = '\0';
    if (!p->serial) return;
    char moving[WR_PICTURE_MOVING];
    wr_picture_moving(p, moving);
    int used = wr_words_print(text, size, "%s  \xc2\xb7  %.1f ms%s%s",
                              wr_words(wr_surfaces[wr_app_scene(app)->shape.kind]->label), all,
                              !moving[0]               ? ""
                              : app->settings->turning ? wr_words("  \xc2\xb7  turning: ")
                                                       : wr_words("  \xc2\xb7  moving: "),
                              moving);
    if (!with_stages) return;
    used += snprintf(text + used, size - (size_t)used, "   ");
    stages(ms, all, text, size, used);
}

static void picture_tip(const WrApp *app)
{
    const WrPreviewPicture *p = wr_preview_picture(app->preview);
    char tip[400];
    double ms[WR_PICTURE_STAGES];
    wr_picture_time(p, ms);
    wr_picture_words(p, tip);
    size_t used = strlen(tip);
    for (int i = 0; i < WR_PICTURE_STAGES; i++)
        used += (size_t)wr_words_print(tip + used, sizeof tip - used, "\n%s %.2f ms",
                                       wr_words(wr_picture_stages[i]), ms[i]);
    wr_gui_tip(tip);
}

static const char *saved_word(const WrApp *app)
{
    return wr_app_unsaved(app)                ? wr_words("not saved")
           : wr_session_path(app->session)[0] ? wr_words("saved")
                                              : wr_words("no changes");
}

/* Width of the left end, independent of its text, so that the right end does not move with the pointer. */
static double left_width(const WrApp *app)
{
    double wide =
        wr_gui_text_width(WR_FONT_TEXT,
                          wr_words("u 0.000 v 0.000 F -0.00000 slope 00.0\xc2\xb0 zoom 0000 %")) +
        wr_gui_px(5 * 14 + 12);
    if (app->view->turn != 0.0)
        wide += wr_gui_text_width(WR_FONT_TEXT, wr_words("turn -000\xc2\xb0")) + wr_gui_px(18);
    return wide;
}

/* Parts of the right end, in order; parts without room are left out, the least important first. */
typedef enum Part {
    PART_PICTURE,
    PART_SIZE,
    PART_MEMORY,
    PART_SAVED,
    PART_LIVE,
    PART_JOURNAL,
    PARTS
} Part;

typedef struct RightEnd {
    char picture[300], size[64];
    const char *text[PARTS]; /* NULL: hidden */
    const char *reason;      /* reason why the journal is not safe */
    bool safe;
} RightEnd;

static double width_of(const RightEnd *end)
{
    double wide = wr_gui_px(12);
    for (int i = 0; i < PARTS; i++)
        if (end->text[i]) wide += wr_gui_text_width(WR_FONT_TEXT, end->text[i]) + wr_gui_px(18);
    return wide;
}

static void make_end(const WrApp *app, RightEnd *end)
{
    static const Part least[] = { PART_SIZE, PART_PICTURE, PART_MEMORY, PART_JOURNAL, PART_LIVE };
    const WrField *field = wr_app_field(app);
    double room = wr_gui_width() - left_width(app);
    *end = (RightEnd){ .reason = "" };
    end->safe = wr_session_journal_safe(app->session, &end->reason);
    picture(app, true, end->picture, sizeof end->picture);
    snprintf(end->size, sizeof end->size, "%d \xc3\x97 %d", wr_field_width(field),
             wr_field_height(field));
    const bool meters = app->settings->meters;
    end->text[PART_PICTURE] = meters ? end->picture : NULL;
    end->text[PART_SIZE] = end->size;
    end->text[PART_MEMORY] = meters ? "8888 MB" : NULL; /* widest text */
    end->text[PART_SAVED] = saved_word(app);
    end->text[PART_LIVE] = app->sheet && app->sheet->live ? wr_words("live") : NULL;
    end->text[PART_JOURNAL] = !end->safe ? wr_words("journal not safe")
                              : meters   ? wr_words("journal safe")
                                         : NULL;
    if (width_of(end) > room) picture(app, false, end->picture, sizeof end->picture);
    for (size_t i = 0; i < WR_LENGTH(least) && width_of(end) > room; i++)
        if (least[i] != PART_JOURNAL || end->safe) end->text[least[i]] = NULL;
}

/* One sentence about the tool in the middle of the line, if all of it fits before `to`. */
static void tool_hint(WrApp *app, double to)
{
    const char *hint = wr_action_help(app, wr_action_find(app, wr_tool_now(app)->action));
    const double from = left_width(app) + wr_gui_px(18);
    if (app->settings->meters || from + wr_gui_text_width(WR_FONT_TEXT, hint) > to) return;
    wr_gui_move_to(from);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_FAINT, hint);
    wr_gui_same_line(18);
}

static void right_side(WrApp *app)
{
    RightEnd end;
    make_end(app, &end);
    tool_hint(app, wr_gui_width() - width_of(&end) - wr_gui_px(18));
    wr_gui_move_to(wr_gui_width() - width_of(&end));
    for (int i = 0; i < PARTS; i++) {
        if (!end.text[i]) continue;
        if (i == PART_MEMORY) memory(app);
        wr_gui_as_it_is(true); /* already translated, so that its width is known */
        if (i != PART_MEMORY)
            wr_gui_text(WR_FONT_TEXT,
                        i == PART_LIVE                   ? WR_COLOUR_CELL
                        : i == PART_JOURNAL && !end.safe ? WR_COLOUR_RAISE
                                                         : WR_COLOUR_LABEL,
                        end.text[i]);
        wr_gui_as_it_is(false);
        if (i == PART_PICTURE && end.picture[0]) picture_tip(app);
        if (i == PART_LIVE)
            wr_gui_tip("Maps are written again after each pause in painting: File, Export maps...");
        if (i == PART_JOURNAL)
            wr_gui_tip(
                end.safe
                    ? "If the program or the computer stops, every change so far can be recovered."
                    : end.reason);
        wr_gui_same_line(18);
    }
}

/* Progress of the computation for a dialog, if it needs longer than a moment. */
static bool work(WrApp *app)
{
    double fraction, seconds;
    const char *as;
    if (wr_sheet_writing(app, &fraction, &seconds, &as) && seconds > MOMENT_SECONDS) {
        char what[80];
        snprintf(what, sizeof what, wr_words("Writing %.40s"), as);
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_STRONG, what);
        wr_gui_same_line(12);
        wr_gui_progress(wr_gui_px(220), fraction);
        wr_gui_same_line(12);
        if (wr_gui_chip(NULL, "Cancel")) wr_sheet_cancel(app);
        return true;
    }
    bool tried = wr_edit_preview_busy(app->trial, &fraction, &seconds) && seconds > MOMENT_SECONDS;
    bool outlined = !tried && wr_outliner_busy(app->marks->outliner, &fraction, &seconds) &&
                    seconds > MOMENT_SECONDS;
    if (!tried && !outlined) return false;
    const WrGenerateState *hand = app->generate;
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_STRONG,
                outlined                          ? "Outlining the selection"
                : app->adjust->op                 ? app->adjust->op->label
                : hand->active && hand->generator ? hand->generator->label
                                                  : "Joining the layers");
    wr_gui_same_line(12);
    wr_gui_progress(wr_gui_px(220), tried ? fraction : -1.0);
    return true;
}

void wr_panel_status(WrApp *app)
{
    if (app->layout->status.w <= 0) return;
    wr_gui_area_begin("##status", WR_AREA_BAR, app->layout->status, WR_COLOUR_BAR);
    if (!work(app)) {
        char text[32];
        double left = left_width(app), wide = wr_gui_width();
        const WrMessage *show = wr_messages_shown(app->messages, wr_clock_seconds());
        /* the message then uses the whole line */
        bool narrow = show && wide - left < wr_gui_px(360);
        if (!narrow) {
            under_pointer(app);
            wr_words_print(text, sizeof text, app->view->zoom < 0.1 ? "%.1f %%" : "%.0f %%",
                           app->view->zoom * 100.0);
            pair(app->view->mirrored ? "mirror" : "zoom", text);
            if (app->view->turn != 0.0) {
                snprintf(text, sizeof text, "%.0f\xc2\xb0", app->view->turn);
                pair("turn", text);
            }
        }
        if (!message(app, narrow ? wr_gui_place() : left)) right_side(app);
    }
    wr_gui_area_end();
}
