/* The window: SDL, the main loop, scheduling of frames. */
#include "ui/app/loop.h"
#include "ui/app/app.h"
#include "ui/panels/accuracy/accuracy.h"
#include "ui/app/canvas_view.h"
#include "ui/app/input_router.h"
#include "ui/app/input.h"
#include "ui/app/idle_probe.h"
#include "ui/app/settings_autosave.h"
#include "ui/app/latency.h"
#include "ui/app/window.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/canvas_derived_map.h"
#include "ui/canvas/outline.h"
#include "ui/app/state/app_options.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/chosen_layers.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/dropped_files.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/action.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/overwrite_question.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/panels/generate/font_choice.h"
#include "ui/panels/generate/generate_presets.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_rows.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/help/guide.h"
#include "ui/panels/missing_files.h"
#include "ui/panels/panel_layer_plan.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/panel_status.h"
#include "ui/panels/panel_dynamics.h"
#include "ui/panels/panel_history.h"
#include "ui/panels/panel_tablet.h"
#include "ui/panels/panels.h"
#include "ui/panels/panel_sheet.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_paint.h"
#include "ui/input/pen.h"
#include "ui/patch/preview/preview.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/thumbs.h"
#include "ui/canvas/tools/tool_stamp.h"
#include "ui/canvas/overlays/marks.h"
#include "ui/canvas/overlays/panel_seam.h"
#include "ui/app/jobs/files.h"
#include "ui/app/jobs/job.h"
#include "ui/app/jobs/edit_preview.h"
#include "ui/app/registry_list.h"
#include "ui/canvas/view.h"
#include "ui/app/state/background_command_internal.h"
#include "ui/panels/panel_adjust.h"
#include "ui/panels/panel_objects.h"
#include "ui/panels/panel_scene.h"
#include "ui/panels/panel_preferences.h"
#include "ui/panels/panel_search.h"
#include "ui/canvas/tools/tool_clone.h"
#include "ui/canvas/tools/tool_shape.h"
#include "ui/canvas/tools/tool_transform.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "command/session.h"
#include "export/film.h"
#include "image/font_list.h"
#include "scene/scene.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>

#define FRAME_SECONDS (1.0 / 125.0) /* least time between two frames */
#define DRAWN_SECONDS                                                                              \
    (1.0 / 300.0)         /* during a drag, so that its effect is visible with low latency */
#define CARET_SECONDS 0.3 /* interval for a text field's blinking caret and for messages */
#define BAR_SECONDS 0.1   /* interval for progress bars */
#define YOUNG_MS 3        /* interval of completion checks while events are held back */

/* ---- life cycle ---- */

bool wr_app_begin(WrApp *app, WrError *err)
{
    wr_settings_begin(app);
    if (!app->settings->window_fonts[WR_GUI_FONT_FILES - 1])
        wr_font_config_begin(); /* while the window opens */
    wr_app_start_ahead(app);
    wr_words_choose(app->settings->language);
    wr_theme_set(app->settings->theme);
    if (!wr_window_open(app)) return wr_fail(err, "no window: %s", SDL_GetError());
    app->drawn_scale = wr_app_wanted_scale(app);
    app->gui = wr_gui_new(app->renderer, app->drawn_scale, app->settings->window_fonts, err);
    if (!app->gui) return false;
    wr_gui_use_folds(app->gui, app->settings->folds);
    wr_gui_use_pins(app->gui, app->settings->pins, WR_PINS_MAX);
    app->ready_event = SDL_RegisterEvents(4);
    app->file_event = app->ready_event + 1;
    app->job_event = app->ready_event + 2;
    app->rest_event = app->ready_event + 3;
    app->trial = wr_edit_preview_new(app->options->threads, app->job_event);
    app->marks->outliner = wr_outliner_new(app->options->threads, app->job_event);
    app->layers->dragged = app->layers->renamed = app->layers->eyes_from = -1;
    app->history->dragged = app->history->menu = -1;
    app->canvas = wr_canvas_new(app->options->threads);
    app->canvas_map = wr_canvas_map_new(app->options->threads, app->job_event);
    app->canvas_second = wr_canvas_map_new(app->options->threads, app->job_event);
    app->preview = wr_preview_new(app->options->threads, app->options->isa, app->ready_event);
    app->files = wr_files_new(app->file_event);
    wr_files_choose_way(app->files, (WrFileWay)app->settings->dialogs);
    wr_files_set_window(app->files, app->window);
    app->hand->input = wr_input_new();
    app->pen = wr_pen_new(app->window);
    wr_tablet_start(app);
    app->keys = wr_keys_new();
    *app->forms = (WrForms){ .picture_width = 2048,
                             .picture_height = 2048,
                             .film_width = 640,
                             .film_height = 640,
                             .film_frames = 120,
                             .film_fps = 25,
                             .film_kind = WR_FILM_MP4,
                             .cells_u = 8,
                             .cells_v = 8,
                             .line_width = 8,
                             .high = 1,
                             .fresh = { .width = 512, .height = 512, .surface = WR_SURFACE_sphere },
                             .solid_size = 100,
                             .solid_error = 0.05,
                             .bake_samples = 2,
                             .bake_padding = 8 };
    app->visible = true;
    wr_app_read_keys(app);
    wr_preset_browser_start(app);
    wr_generate_new(app);
    wr_accuracy_panel_new(app);
    app->rest = app->latency ? NULL : wr_idle_probe_new(app->rest_event);
    if (!wr_app_start(app, err)) return false;
    if (app->options->brush) wr_preset_browser_take_file(app, app->options->brush);
    const char *fonts = wr_gui_missing_fonts(app->gui);
    WrError missing;
    if (fonts && !wr_fail(&missing, "%s", fonts)) wr_app_fail(app, &missing);
    wr_app_title(app);
    if (!app->latency) wr_dialog_recover_open(app);
    if (!app->latency) wr_welcome_open(app);
    SDL_ShowWindow(app->window);
    SDL_StartTextInput();
    wr_app_redraw(app);
    return true;
}

void wr_app_end(WrApp *app)
{
    wr_app_start_join(app);
    wr_busy_stop(app);
    wr_idle_probe_free(app->rest);
    wr_preview_free(app->preview);
    wr_accuracy_free(app);
    wr_edit_preview_free(app->trial);
    wr_marks_free(app);
    wr_seam_meter_free(app);
    wr_recovery_free(app->recovery);
    wr_deferred_free(app);
    wr_busy_free(app);
    wr_patch_paint_free(app);
    if (app->renderer) wr_patch_free(app);
    wr_thumbs_free(app);
    wr_script_list_free(&app->shelf->cells);
    wr_script_list_free(&app->shelf->starters);
    wr_preset_browser_free(app);
    wr_stamp_forget(app);
    wr_sheet_free(app);
    wr_gallery_free(app);
    wr_font_choice_free(app);
    wr_generate_free(app);
    wr_guide_free(app);
    wr_search_index_free(&app->finder->index);
    if (app->renderer) wr_panel_layers_forget(app);
    if (app->renderer) wr_panel_drop_forget(app);
    wr_dropped_free(app->dropped);
    wr_missing_files_free(app);
    wr_history_panel_free(app);
    wr_canvas_free(app->canvas);
    wr_canvas_map_free(app->canvas_map);
    wr_canvas_map_free(app->canvas_second);
    wr_gui_free(app->gui);
    wr_files_free(app->files);
    wr_pen_free(app->pen);
    wr_input_free(app->hand->input);
    wr_dynamics_free(app);
    wr_tablet_free(app);
    wr_keys_free(app->keys);
    if (app->live) wr_scene_free(app->live);
    wr_messages_free(app->messages);
    wr_strokes_free(app);
    wr_settings_fini(app->settings);
    wr_settings_fini(app->settings_known);
    wr_free(app->file->after_path);
    wr_free(app->file->picture);
    wr_free(app->replace->path);
    wr_free(app->replace->found);
    for (int i = 0; i < SDL_NUM_SYSTEM_CURSORS; i++)
        if (app->cursors[i]) SDL_FreeCursor(app->cursors[i]);
    if (app->renderer) SDL_DestroyRenderer(app->renderer);
    if (app->window) SDL_DestroyWindow(app->window);
    SDL_QuitSubSystem(SDL_INIT_VIDEO);
    SDL_Quit();
}

/* ---- events ---- */

static bool is_hand(const SDL_Event *event)
{
    return event->type == SDL_MOUSEBUTTONDOWN || event->type == SDL_KEYDOWN;
}

static void handle(WrApp *app, const SDL_Event *event)
{
    WrPenEvent pen;
    wr_busy_update(app);
    if (is_hand(event)) app->fitted = true;
    if (event->type == app->ready_event) return; /* patch_update fetches the picture */
    if (event->type == app->rest_event) {
        wr_idle_probe_requested(app);
        return;
    }
    while (wr_pen_next_before(app->pen, event, &pen)) wr_input_router_pen(app, &pen);
    if (event->type == app->job_event) { /* the component that needs the result fetches it */
        wr_app_redraw(app);
        return;
    }
    if (wr_busy_event(app, event)) return;
    wr_gui_event(app->gui, event);
    app->input_at = wr_clock_seconds();
    wr_app_redraw(app);
    if (wr_busy_view_event(app, event)) return;
    if (event->type == SDL_QUIT) { /* a signal; while the question is open, one skips it */
        if (app->dialog->now == WR_DIALOG_UNSAVED) {
            wr_session_journal_leave(
                app->session); /* unanswered, as at a logout: recovered later */
            app->quit = true;
        } else {
            wr_app_quit(app);
        }
    } else if (event->type == SDL_WINDOWEVENT) {
        wr_window_event(app, event);
    } else if (event->type == SDL_DROPFILE) {
        if (event->drop.file) wr_app_drop(app, event->drop.file);
        SDL_free(event->drop.file);
    } else if (event->type == SDL_RENDER_TARGETS_RESET || event->type == SDL_RENDER_DEVICE_RESET) {
        for (const WrPart *const *p = app->registry->parts; *p; p++)
            if ((*p)->forget) (*p)->forget(app);
    } else if (event->type == app->file_event) {
        WrFilePurpose purpose;
        if (!wr_files_hear(app->files)) {
            wr_dialog_open(app, WR_DIALOG_FILE);
            return;
        }
        const char *path = wr_files_answer(app->files, &purpose);
        if (path) wr_app_file_chosen(app, purpose, path);
        else app->file->after = WR_AFTER_NOTHING;
    } else {
        wr_input_router_event(app, event);
    }
}

/* ---- drawing ---- */

static SDL_SystemCursor cursor_for(const WrApp *app)
{
    const WrInputRouter *hand = app->hand;
    const WrGrab divider =
        hand->grab == WR_GRAB_NONE && !wr_gui_owns_point(app->gui, (int)hand->at.x, (int)hand->at.y)
            ? wr_divider_under(app, &hand->at)
            : hand->grab;
    if (divider == WR_GRAB_DIVIDER)
        return app->layout->stacked ? SDL_SYSTEM_CURSOR_SIZENS : SDL_SYSTEM_CURSOR_SIZEWE;
    if (divider == WR_GRAB_PANELS) return SDL_SYSTEM_CURSOR_SIZENS;
    if (divider == WR_GRAB_SIDE) return SDL_SYSTEM_CURSOR_SIZEWE;
    if (hand->grab == WR_GRAB_SPLIT || (hand->grab == WR_GRAB_NONE && hand->on_patch &&
                                        wr_accuracy_on_line(app, hand->at.x, hand->at.y)))
        return SDL_SYSTEM_CURSOR_SIZEWE;
    if (hand->on_canvas && (hand->grab == WR_GRAB_PAN || hand->space))
        return SDL_SYSTEM_CURSOR_SIZEALL;
    if (hand->on_canvas) return SDL_SYSTEM_CURSOR_CROSSHAIR;
    if (hand->grab == WR_GRAB_PATCH_PAINT ||
        (hand->on_patch && wr_patch_paints(app) && !wr_patch_control_under(app, &hand->at)))
        return SDL_SYSTEM_CURSOR_CROSSHAIR;
    if (hand->on_patch)
        return hand->grab == WR_GRAB_NONE ? SDL_SYSTEM_CURSOR_HAND : SDL_SYSTEM_CURSOR_SIZEALL;
    return wr_gui_cursor(app->gui);
}

static void set_cursor(WrApp *app)
{
    SDL_SystemCursor wanted = cursor_for(app);
    if (wanted == app->cursor && app->cursors[wanted]) return;
    if (!app->cursors[wanted]) app->cursors[wanted] = SDL_CreateSystemCursor(wanted);
    if (app->cursors[wanted]) SDL_SetCursor(app->cursors[wanted]);
    app->cursor = wanted;
}

/* A divider with three dots as its grip. */
static void draw_divider(const SDL_Rect *d, bool hot)
{
    const double dot = wr_gui_px(1.5), gap = wr_gui_px(6);
    const bool tall = d->h > d->w;
    if (d->w <= 0) return;
    wr_gui_draw_fill(d->x, d->y, d->w, d->h, hot ? WR_COLOUR_SELECTED : WR_COLOUR_LINE, 0);
    for (int i = -1; i <= 1; i++)
        wr_gui_draw_disc(d->x + d->w / 2.0 + (tall ? 0 : i * gap),
                         d->y + d->h / 2.0 + (tall ? i * gap : 0), dot, WR_COLOUR_FAINT);
}

static void draw_views(WrApp *app)
{
    for (const WrPart *const *p = app->registry->parts; *p; p++)
        if ((*p)->draw) (*p)->draw(app);
    draw_divider(&app->layout->divider, app->hand->grab == WR_GRAB_DIVIDER);
    draw_divider(&app->layout->panel_divider, app->hand->grab == WR_GRAB_PANELS);
    draw_divider(&app->layout->side, app->hand->grab == WR_GRAB_SIDE);
}

void wr_app_draw_parts(WrApp *app, bool views)
{
    app->in_frame = true;
    wr_panel_menu(app);
    wr_app_make_layout(app);
    wr_app_place_view(app);
    wr_panel_options(app);
    wr_panel_tools(app);
    wr_panel_right(app);
    if (views) draw_views(app);
    wr_canvas_view_overlay(app);
    wr_patch_overlay(app);
    wr_patch_paint_overlay(app);
    wr_accuracy_overlay(app);
    if (!wr_busy_bar(app)) wr_panel_status(app);
    wr_panel_dialogs(app);
    app->in_frame = false;
}

static void draw(WrApp *app, double now)
{
    WrError err;
    double scale = wr_app_wanted_scale(app);
    if (scale != app->drawn_scale || wr_theme() != app->settings->theme) {
        if (wr_theme() != app->settings->theme) wr_canvas_forget(app->canvas);
        wr_theme_set(app->settings->theme);
        if (!wr_gui_set_scale(app->gui, scale, &err)) wr_app_fail(app, &err);
        app->drawn_scale = scale;
        app->redraw = 2;
    }
    int width, height;
    SDL_GetRendererOutputSize(app->renderer, &width, &height);
    wr_gui_frame_begin(app->gui, width, height, now - app->drawn_at);
    wr_app_draw_parts(app, true);
    wr_thumbs_update(app);
    wr_input_collect(app); /* these came while the previous frame was on the screen */
    wr_gui_frame_end(app->gui);
    wr_input_shown(app);
    wr_input_router_update_hover(app);
    set_cursor(app);
    app->drawn_at = now;
    if (app->redraw < 1 && wr_gui_unsettled(app->gui)) app->redraw = 1;
    if (app->drawn) app->drawn(app);
}

/* ---- main loop ---- */

/* True if a background computation shows a progress bar. */
static bool works(WrApp *app)
{
    bool any = wr_edit_preview_busy(app->trial, NULL, NULL);
    for (const WrPart *const *p = app->registry->parts; *p; p++)
        if ((*p)->works && (*p)->works(app)) any = true;
    return any;
}

static double frame_seconds(const WrApp *app)
{
    return app->hand->grab != WR_GRAB_NONE ? DRAWN_SECONDS : FRAME_SECONDS;
}

/* Milliseconds until an update is due without an event; -1: never. */
static int wait_time(WrApp *app, double now)
{
    double next = 1e300;
    if (wr_strokes_waits(app)) return 0;
    if (wr_input_waits(app) && app->redraw == 0) return 0;
    if (wr_pen_replaying(app->pen)) next = now + 0.002;
    if (app->redraw > 0 && app->visible) next = app->drawn_at + frame_seconds(app);
    const double pens = wr_pen_wait(app->pen);
    if (pens > 0.0 && now + pens < next) next = now + pens;
    for (const WrPart *const *p = app->registry->parts; *p; p++) {
        double due = (*p)->next_time ? (*p)->next_time(app) : 0.0;
        if (due > 0.0 && due < next) next = due;
    }
    double settings = wr_settings_next_autosave(app);
    if (settings > 0.0 && settings < next) next = settings;
    if ((app->busy || works(app)) && app->drawn_at + BAR_SECONDS < next)
        next = app->drawn_at + BAR_SECONDS;
    bool young = app->messages->list.count > 0 &&
                 now - app->messages->list.data[app->messages->list.count - 1].since < 7.0;
    bool alive = wr_gui_wants_text(app->gui) || wr_gui_has_pending_timer(app->gui) || young;
    if (alive && app->drawn_at + CARET_SECONDS < next) next = app->drawn_at + CARET_SECONDS;
    if (wr_gui_has_pending_timer(app->gui) && now + 0.05 < next) next = now + 0.05;
    const double lit = wr_gui_light_left(app->gui); /* the highlight of a found row is removed */
    if (lit >= 0.0 && now + lit < next) next = now + lit;
    if (next > 1e299) return -1;
    double ms = ceil((next - now) * 1e3);
    return ms < 0.0 ? 0 : ms > 60000.0 ? 60000 : (int)ms;
}

/* Move pen and finger events to the queue; they do not come through SDL. */
static bool take_pens(WrApp *app)
{
    WrPenEvent event;
    bool any = false;
    while (wr_pen_next(app->pen, &event)) {
        wr_input_router_pen(app, &event);
        any = true;
    }
    return any;
}

/* Report once that the system refused threads; the work is done without them. */
static void report_refused(WrApp *app)
{
    if (wr_thread_refused())
        wr_app_say(
            app, "The system allows no more threads: long work blocks the window until it is done");
}

/* Handle all events that need not wait. True if there was one. */
static bool handle_input(WrApp *app)
{
    SDL_Event event;
    bool any = false;
    while (wr_input_next(app, &event)) {
        handle(app, &event);
        wr_input_handled(app, &event);
        any = true;
        wr_input_collect(app);
    }
    return any;
}

/* Wait for events or due updates, and handle them. */
static void take_events(WrApp *app)
{
    int wait = wait_time(app, wr_clock_seconds());
    if (wait < 0) SDL_WaitEvent(NULL);
    else if (wait > 0) SDL_WaitEventTimeout(NULL, wait);
    wr_input_collect(app);
    bool came = handle_input(app);
    /* Pen events follow the waiting events. */
    if (!wr_input_waits(app) && take_pens(app)) came = true;
    if (came) return;
    if (wr_gui_wants_text(app->gui) || wr_gui_has_pending_timer(app->gui) ||
        app->messages->list.count > 0 || app->busy || works(app)) {
        if (app->redraw == 0) app->redraw = 1;
    }
}

void wr_app_step(WrApp *app)
{
    wr_busy_update(app);
    if (wr_busy_is_young(app)) SDL_Delay(YOUNG_MS);
    else take_events(app);
    report_refused(app);
    if (!app->busy) wr_app_compact_journal(app);
    wr_strokes_work(app);
    wr_deferred_run(app);
    if (app->redraw == 0 && wr_gui_light_left(app->gui) == 0.0) app->redraw = 1;
    for (const WrPart *const *p = app->registry->parts; *p; p++)
        if ((*p)->update) (*p)->update(app);
    const double now = wr_clock_seconds();
    if (app->redraw > 0 && app->visible && now >= app->drawn_at + frame_seconds(app) - 0.0005) {
        app->redraw--;
        draw(app, now);
        app->draw_seconds = wr_clock_seconds() - now;
        wr_timing_note(app, app->draw_seconds);
    }
    for (const WrPart *const *p = app->registry->parts; *p; p++)
        if ((*p)->after) (*p)->after(app);
    wr_settings_autosave(app);
    wr_idle_probe_step(app, app->busy || works(app));
}

int wr_app_run(const WrAppOptions *options)
{
    WrError err = { "" };
    WrApp *app = wr_store_new();
    app->options = options;
    app->session = options->session;
    app->started_at = wr_clock_seconds();
    int status = 0;
    if (wr_app_begin(app, &err)) {
        while (!app->quit) wr_app_step(app);
        wr_settings_end(app);
        wr_timing_report(app);
    } else {
        fprintf(stderr, "wrinkle: %s\n", err.text);
        status = 1;
    }
    wr_app_end(app);
    wr_free(app);
    return status;
}

/* ---- one memory block for the state of all components ---- */

typedef struct Store {
    WrApp app; /* the first member: freeing it frees the block */
    WrSettings settings;
    WrSettings settings_known;
    WrLayout layout;
    WrTiming timing;
    WrCanvasView view;
    WrCanvasRange range, map_range;
    WrInputRouter hand;
    WrBrushState brush;
    WrBrushSources brush_files;
    WrPresetBrowser shelf;
    WrDrawState draw;
    WrPatch patch;
    WrPatchPaint paint;
    WrMarks marks;
    WrSelectState select;
    WrChosenLayers chosen;
    WrDroppedFiles dropped;
    WrLayersState layers;
    WrLayerPlanState layer_plan;
    WrHistoryState history;
    WrSurfaceState surface;
    WrObjectsState objects;
    WrAdjust adjust;
    WrOutlineRequest selecting;
    WrFinder finder;
    WrPreferences preferences;
    WrMeter meter;
    WrDeferred later;
    WrWaits waits;
    WrMessages messages;
    WrForms forms;
    WrReplace replace;
    WrCloneState clone;
    WrTransformState transform;
    WrStampState stamp;
    WrDialogState dialog;
    WrDocumentState file;
} Store;

WrApp *wr_store_new(void)
{
    Store *store = wr_alloc(1, sizeof *store);
    WrApp *app = &store->app;
    app->settings = &store->settings;
    app->settings_known = &store->settings_known;
    app->layout = &store->layout;
    app->timing = &store->timing;
    app->view = &store->view;
    app->range = &store->range;
    app->map_range = &store->map_range;
    app->hand = &store->hand;
    app->brush = &store->brush;
    app->brush_files = &store->brush_files;
    app->shelf = &store->shelf;
    app->draw = &store->draw;
    app->patch = &store->patch;
    app->paint = &store->paint;
    app->marks = &store->marks;
    app->select = &store->select;
    app->chosen = &store->chosen;
    app->dropped = &store->dropped;
    app->layers = &store->layers;
    app->layer_plan = &store->layer_plan;
    app->history = &store->history;
    app->surface = &store->surface;
    app->objects = &store->objects;
    app->adjust = &store->adjust;
    app->selecting = &store->selecting;
    app->finder = &store->finder;
    app->preferences = &store->preferences;
    app->meter = &store->meter;
    app->later = &store->later;
    app->waits = &store->waits;
    app->messages = &store->messages;
    app->forms = &store->forms;
    app->replace = &store->replace;
    app->clone = &store->clone;
    app->transform = &store->transform;
    app->stamp = &store->stamp;
    app->dialog = &store->dialog;
    app->file = &store->file;
    app->registry = &wr_registry;
    return app;
}
