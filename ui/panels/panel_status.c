/* The status line: what is under the pointer, what the last picture cost, what there is to say. */
#include "ui/gui/words.h"
#include "ui/panels/panel_status.h"
#include "ui/canvas/outline.h"
#include "ui/canvas/view.h"
#include "ui/desk/desk.h"
#include "ui/desk/hand.h"
#include "ui/desk/layout.h"
#include "ui/desk/messages.h"
#include "ui/desk/session_view.h"
#include "ui/desk/settings.h"
#include "ui/generate/generate_hand.h"
#include "ui/gui/gui.h"
#include "ui/gui/theme.h"
#include "ui/panels/panel_adjust.h"
#include "ui/panels/panel_sheet.h"
#include "ui/preview/preview.h"
#include "ui/views/marks.h"
#include "ui/jobs/trial.h"

#include "base/exactmath.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "field/scheme.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "system/clock.h"
#include "system/process.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define METER_SECONDS 2.0
#define MOMENT_SECONDS 0.2 /* work that takes less shows no bar */

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
    app->messages->unread = 0;
    wr_app_redraw(app);
}

static void all_messages(const WrApp *app)
{
    const WrMessages *m = app->messages;
    if (!wr_gui_popup_begin("messages")) return;
    wr_gui_heading("MESSAGES");
    for (int i = m->list.count - 1; i >= 0 && i >= m->list.count - 12; i--) {
        char line[128];
        snprintf(line, sizeof line, "%.124s", m->list.data[i].text);
        wr_gui_as_it_is(true); /* said already */
        wr_gui_text(WR_FONT_TEXT, m->list.data[i].bad ? WR_COLOUR_BAD : WR_COLOUR_TEXT, line);
        wr_gui_tip(m->list.data[i].text);
        wr_gui_as_it_is(false);
    }
    wr_gui_popup_end();
}

/* How many errors nobody has read: a click shows them all. */
static void unread_errors(WrApp *app)
{
    char count[32];
    snprintf(count, sizeof count,
             app->messages->unread == 1 ? wr_words("%d error") : wr_words("%d errors"),
             app->messages->unread);
    if (wr_gui_chip(WR_ICON_ALERT, count)) {
        wr_gui_popup_open("messages");
        dismiss(app);
    }
    wr_gui_tip("Errors that were not read yet");
    wr_gui_same_line(8);
}

/* The newest message is what is seen: an error until it is read, a note while it is young. Errors before it
   are counted. False if the rest of the line is free. */
static bool message(WrApp *app)
{
    const WrMessage *show = wr_messages_shown(app->messages, wr_clock_seconds());
    bool error = show && show->bad;
    if (error) {
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_BAD, WR_ICON_ALERT);
        wr_gui_same_line(6);
        if (wr_gui_chip(NULL, "Dismiss")) dismiss(app);
        wr_gui_same_line(6);
        if (wr_gui_chip(NULL, "All")) wr_gui_popup_open("messages");
        wr_gui_same_line(8);
    } else if (app->messages->unread > 0) {
        unread_errors(app);
    }
    all_messages(app);
    if (!show) return false;
    wr_gui_as_it_is(true);
    wr_gui_text(WR_FONT_TEXT, error ? WR_COLOUR_STRONG : WR_COLOUR_TEXT, show->text);
    wr_gui_tip(show->text);
    wr_gui_as_it_is(false);
    return true;
}

/* Where the picture's time went, in percent. */
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

/* Looked at now and then: counting the tiles of a large table takes a moment. */
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
    snprintf(text, sizeof text, "%.3g MB", m->all / 1e6);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, text);
    double rest = m->all - m->tiles - m->undo;
    snprintf(
        tip, sizeof tip,
        wr_words(
            "Memory\nlayers and selection %.3g MB\nundo %.3g MB\npictures, caches and the program "
            "%.3g MB"),
        m->tiles / 1e6, m->undo / 1e6, rest > 0.0 ? rest / 1e6 : 0.0);
    wr_gui_tip(tip);
}

/* ---- the right end ---- */

static void picture(const WrApp *app, bool with_stages, char *text, size_t size)
{
    const WrPreviewPicture *p = wr_preview_picture(app->preview);
    double ms[WR_PICTURE_STAGES], all = wr_picture_time(p, ms);
    text[0] = '\0';
    if (!p->serial) return;
    char moving[WR_PICTURE_MOVING];
    wr_picture_moving(p, moving);
    int used = snprintf(text, size, "%s  \xc2\xb7  %.1f ms%s%s",
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
        used += (size_t)snprintf(tip + used, sizeof tip - used, "\n%s %.2f ms",
                                 wr_words(wr_picture_stages[i]), ms[i]);
    wr_gui_tip(tip);
}

static const char *saved_word(const WrApp *app)
{
    return wr_app_unsaved(app)                ? wr_words("not saved")
           : wr_session_path(app->session)[0] ? wr_words("saved")
                                              : wr_words("no changes");
}

/* What the left end may take: the same whatever it says, so that the right one does not change with the pointer. */
static double left_width(void)
{
    return wr_gui_text_width(
               WR_FONT_TEXT,
               wr_words("u 0.000 v 0.000 F -0.00000 slope 00.0\xc2\xb0 zoom 0000 %")) +
           wr_gui_px(5 * 14 + 12);
}

static void right_side(WrApp *app)
{
    const WrField *field = wr_app_field(app);
    const char *reason = "", *saved = saved_word(app);
    char render[300], size[64];
    bool safe = wr_session_journal_safe(app->session, &reason);
    const char *journal = safe ? wr_words("journal safe") : wr_words("journal not safe");
    const bool live = app->sheet && app->sheet->live;
    picture(app, true, render, sizeof render);
    snprintf(size, sizeof size, "%d \xc3\x97 %d", wr_field_width(field), wr_field_height(field));
    double gap = wr_gui_px(18), memory_width = wr_gui_text_width(WR_FONT_TEXT, "8888 MB");
    double others = memory_width + 4 * gap + wr_gui_px(12);
    const char *const parts[] = { size, saved, journal, "live" };
    if (live) others += gap;
    for (int i = 0; i < (live ? 4 : 3); i++) others += wr_gui_text_width(WR_FONT_TEXT, parts[i]);
    double width = others + wr_gui_text_width(WR_FONT_TEXT, render);
    if (width + left_width() > wr_gui_width()) {
        picture(app, false, render, sizeof render);
        width = others + wr_gui_text_width(WR_FONT_TEXT, render);
    }
    wr_gui_move_to(wr_gui_width() - width);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, render);
    if (render[0]) picture_tip(app);
    wr_gui_same_line(18);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, size);
    wr_gui_same_line(18);
    memory(app);
    wr_gui_same_line(18);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, saved);
    if (live) {
        wr_gui_same_line(18);
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_CELL, "live");
        wr_gui_tip("Maps are written again after each pause of the hand: File, Export maps...");
    }
    wr_gui_same_line(18);
    wr_gui_text(WR_FONT_TEXT, safe ? WR_COLOUR_LABEL : WR_COLOUR_RAISE, journal);
    wr_gui_tip(safe ? "Should the program or the computer stop, every change so far can be brought "
                      "back."
                    : reason);
}

/* What is being computed for a dialog, if it takes longer than a moment. */
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
    bool tried = wr_trial_busy(app->trial, &fraction, &seconds) && seconds > MOMENT_SECONDS;
    bool outlined = !tried && wr_outliner_busy(app->marks->outliner, &fraction, &seconds) &&
                    seconds > MOMENT_SECONDS;
    if (!tried && !outlined) return false;
    const WrGenerateHand *hand = app->generate;
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
    if (!work(app) && !message(app)) {
        char text[32];
        under_pointer(app);
        snprintf(text, sizeof text, app->view->zoom < 0.1 ? "%.1f %%" : "%.0f %%",
                 app->view->zoom * 100.0);
        pair(app->view->mirrored ? "mirror" : "zoom", text);
        if (app->view->turn != 0.0) {
            snprintf(text, sizeof text, "%.0f\xc2\xb0", app->view->turn);
            pair("turn", text);
        }
        right_side(app);
    }
    wr_gui_area_end();
}
