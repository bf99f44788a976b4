/* calls.h - what the window's files offer each other. Included by state.h, after the types. */
#pragma once
#include "ui/state.h"

/* ---- app.c ---- */
/* One window's life, for wr_app_run and latency.c. end after begin even if that failed. */
bool wr_app_begin(WrApp *app, WrError *err);
void wr_app_step(WrApp *app); /* wait for something, do it, draw */
void wr_app_end(WrApp *app);
void wr_app_redraw(WrApp *app);
void wr_app_make_layout(WrApp *app);
void wr_app_tend(WrApp *app); /* the journal, when nothing else is to do */
double wr_app_wanted_scale(const WrApp *app);
void wr_app_set_scale(WrApp *app, double setting); /* 0: the display's */
void wr_app_read_keys(WrApp *app);                 /* built in, the chosen map, the user's file */

/* ---- window.c ---- */
bool wr_window_open(WrApp *app); /* hidden, with its renderer; false: SDL_GetError says why */
double wr_window_scale(SDL_Window *window); /* what its display asks for, in steps of 1/4 */
/* The window with what a window manager put around it stays within what the desktop leaves free, so that the
   status line is on the screen. Known only once it is shown, and looked at until a hand has been at it. */
void wr_window_keep(WrApp *app);
void wr_window_event(WrApp *app, const SDL_Event *event);

/* ---- document.c: the document behind the window ---- */
/* What the views show: the composite, or what it would become by what is being tried. */
const WrField *wr_app_field(const WrApp *app);
const WrDocument *wr_app_document(const WrApp *app);
/* Show what this would give; the document is not touched. */
void wr_app_try(WrApp *app, const WrTrialAsk *ask);
void wr_app_try_end(WrApp *app);
const WrScene *wr_app_scene(const WrApp *app); /* live if a value is being dragged */
bool wr_app_unsaved(const WrApp *app);
/* Run a command line, as wr_busy_run does; a failure becomes a message. */
bool wr_app_run_line(WrApp *app, const char *line);
bool wr_app_run_linef(WrApp *app, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* A scene that the caller may change at once; the preview shows it until wr_app_live_end. */
WrScene *wr_app_live(WrApp *app);
void wr_app_live_end(WrApp *app);
void wr_app_start(WrApp *app); /* the starter, or what was asked for */
void wr_app_new(WrApp *app);
void wr_app_open(WrApp *app);
void wr_app_open_path(WrApp *app, const char *path); /* asks first if work is unsaved */
/* The same for a new document that command lines make. */
void wr_app_open_lines(WrApp *app, const char *lines);
bool wr_app_save(WrApp *app); /* false: not saved yet (a dialog is open, or it failed) */
void wr_app_save_as(WrApp *app);
void wr_app_save_history(WrApp *app); /* asks for the file */
/* The document is another one: forget what belonged to the old one. */
void wr_app_changed_document(WrApp *app);
void wr_app_quit(WrApp *app);
void wr_app_go_on(WrApp *app); /* with `after` */
/* A dialog gave that name: read it, or write it, after asking where another file would go. */
void wr_app_file_chosen(WrApp *app, WrFilePurpose purpose, const char *path);
/* Without asking, for each purpose. */
void wr_file_take_open(WrApp *app, const char *path);
void wr_file_take_save(WrApp *app, const char *path);
void wr_file_take_import(WrApp *app, const char *path);
void wr_file_take_export(WrApp *app, const char *path);
void wr_file_take_history(WrApp *app, const char *path);
void wr_app_title(WrApp *app);
const char *wr_app_name(const WrApp *app); /* of the document, without folders */

/* ---- replace.c: files that would go ---- */
/* If a file stands there, ask whether it may be replaced, and do it then: true. False: there is none. */
bool wr_replace_ask(WrApp *app, WrReplaceKind kind, WrFilePurpose purpose, const char *path);
void wr_dialog_replace(WrApp *app);

/* ---- busy.c: what may take long ---- */
/* Call work(ctx), on another thread, and come back when it is done: with what it said. What takes longer
   than a moment shows `what`, a bar, how long it will still take, and Cancel; the window stays alive, but
   nothing else can be done. Only work(ctx) touches the session meanwhile. Also inside a picture of the window. */
typedef bool WrBusyWork(void *ctx, WrError *err);
bool wr_busy_run(WrApp *app, const char *what, WrBusyWork *work, void *ctx, WrError *err);
/* Say why the newest one failed: an error, or a note where it was the user who gave it up. */
void wr_busy_fail(WrApp *app, const char *what, const WrError *err);
/* Run a line that is being tried just so, on the document as it is: where the trial has made it, that is taken
   instead of being made again. */
void wr_app_run_tried(WrApp *app, const char *line);
/* Run a command that may take long, at once or after the picture of the window that is being made. */
void wr_app_run_slow(WrApp *app, const char *line);
bool wr_app_line_waits(const WrApp *app); /* one is to be run after this picture */

/* ---- later.c: after the picture of the window that is being made ---- */
/* work(app, text) then; what was put off of the same kind before is not done. */
void wr_later(WrApp *app, WrLaterWork *work, const char *text);
bool wr_later_waits(const WrApp *app, WrLaterWork *work); /* NULL: any */
void wr_later_run(WrApp *app);                            /* do what was put off */
void wr_later_free(WrApp *app);

/* ---- marks.c: outlines of selections ---- */
void wr_marks_update(WrApp *app);
void wr_marks_draw(WrApp *app);
void wr_marks_try(WrApp *app, const WrOutlineAsk *ask); /* NULL: the selection as it is */
double wr_marks_next_time(const WrApp *app); /* clock at which they move on; 0: they do not */
void wr_marks_free(WrApp *app);

/* ---- messages.c ---- */
void wr_app_say(WrApp *app, const char *format, ...) __attribute__((format(printf, 2, 3)));
void wr_app_say_lines(WrApp *app, const char *text); /* each line by itself */
void wr_app_fail(WrApp *app, const WrError *err);
void wr_app_take_notes(WrApp *app);
/* What the status line says: the newest message, an error until it is read, a note while it is young; or
   NULL. */
const WrMessage *wr_messages_shown(const WrMessages *messages, double now);
void wr_messages_free(WrMessages *messages);

/* ---- hand.c: pointer and keys ---- */
void wr_hand_event(WrApp *app, const SDL_Event *event);
void wr_hand_pen(WrApp *app, const WrPenEvent *event);
/* After a picture of the window: where widgets came or went, the pointer is on a view or no more, though it did
   not move. */
void wr_hand_look(WrApp *app);
void wr_hand_end(WrApp *app);    /* end what is being held, keeping what was done */
void wr_hand_cancel(WrApp *app); /* end it as if it had not begun */
void wr_app_place_view(WrApp *app);

/* ---- tools ---- */
void wr_brush_press(WrApp *app, const WrPointer *at);
void wr_brush_drag(WrApp *app, const WrPointer *at);
void wr_brush_release(WrApp *app, const WrPointer *at);
void wr_brush_overlay(WrApp *app);
/* The steadied hand: each point that comes out of a motion is given to `draw`. */
void wr_brush_steady_begin(WrApp *app, const WrPointer *at);
void wr_brush_steady_move(WrApp *app, const WrPointer *at,
                          void (*draw)(WrApp *app, const WrPointer *at));
void wr_brush_steady_end(WrApp *app, const WrPointer *at,
                         void (*draw)(WrApp *app, const WrPointer *at));
void wr_brush_resize(WrApp *app, const WrPointer *at);
void wr_brush_pick(WrApp *app, const WrPointer *at);
void wr_brush_options(WrApp *app);

/* ---- brush_outline.c ---- */
typedef struct WrBrushMark { /* the shape of the next dab */
    double radius;           /* texels; follows the pressure of a stroke under way */
    double aspect, turn;     /* length over breadth; radians, anticlockwise as seen */
    bool square;             /* a stamp */
    bool erases;
} WrBrushMark;
#define WR_BRUSH_MARK_POINTS 48
WrBrushMark wr_brush_mark(const WrApp *app);
/* Its outline about (0,0): texels to the right and DOWN, [WR_BRUSH_MARK_POINTS]; returns how many. */
int wr_brush_mark_points(const WrBrushMark *mark, double points[][2]);
void wr_brush_show_string(const WrApp *app); /* from what is drawn to the pointer */

/* ---- stroke_hand.c: strokes, drawn a few milliseconds a picture ---- */
/* The stroke command without points for a brush, with the files that app->brush_files names. */
void wr_strokes_head(const WrApp *app, const WrBrush *brush, WrText *line);
/* The brush as a pointer has it: the eraser's end erases, held keys smooth or invert; a new seed where there
   is chance in it. */
WrBrush wr_strokes_brush(WrApp *app, const WrPointer *at);
bool wr_strokes_begin(WrApp *app, const WrBrush *brush, const WrPointer *at);
/* One sample at (u, v) of the table, unwrapped, with the pointer's pressure, tilt and time. */
void wr_strokes_sample(WrApp *app, const WrPointer *at, double u, double v);
void wr_strokes_end(WrApp *app);         /* no more samples; what is left is drawn by and by */
void wr_strokes_work(WrApp *app);        /* once before each picture */
bool wr_strokes_waits(const WrApp *app); /* more is left to draw */
void wr_strokes_finish(WrApp *app);      /* draw all that is left, now */
void wr_strokes_cancel(WrApp *app);      /* the stroke that is drawn never was */
void wr_strokes_free(WrApp *app);

/* ---- tool_shape.c, tool_path.c, tool_fill.c, tool_ramp.c, tool_clone.c, tool_stamp.c ---- */
void wr_shape_options(WrApp *app);
void wr_draw_leave(WrApp *app); /* gives up what is being drawn */
bool wr_stamp_choose(WrApp *app, const char *path);
void wr_stamp_take(WrApp *app, const char *path); /* of a file that was chosen */
void wr_stamp_forget(WrApp *app);                 /* at the end */
/* stamps.c: pictures in the folders of brushes, ours, the user's and GIMP's, in draw.stamps. */
void wr_stamps_find(WrApp *app);
void wr_stamp_picker(WrApp *app); /* a picture in the option row that opens all of them */
void wr_stamps_free(WrApp *app);
/* The brush's arguments for a command that is no stroke: symmetric or not. */
void wr_draw_brush_line(const WrApp *app, WrText *line, bool symmetric);

/* ---- overlay.c: lines on the canvas, on every copy of the cell ---- */
/* points: u, v, unwrapped. dark under light, so that they are seen on any ground. */
void wr_overlay_lines(const WrApp *app, const WrSelectPoint *points, int count, bool closed,
                      WrColour colour);
/* A cross, a small square or disc at a place; also on all copies. size: units. */
void wr_overlay_cross(const WrApp *app, double u, double v, WrColour colour);
void wr_overlay_handle(const WrApp *app, double u, double v, bool round, bool hot);
/* Texel place of a pointer, unwrapped; and back to u, v. */
WrSelectPoint wr_overlay_uv(const WrApp *app, double x, double y);
/* Whole cells to add to u, v so that it lies in the real cell (on axes that wrap). */
WrSelectPoint wr_overlay_home(const WrApp *app, double u, double v);
void wr_overlay_label(double x, double y, const char *text); /* centred at a pixel */

/* ---- symmetry.c ---- */
void wr_symmetry_apply(WrApp *app); /* the settings' symmetry becomes the brush's, or none */
void wr_symmetry_marks(WrApp *app); /* axes, on the canvas */
bool wr_symmetry_press(WrApp *app, const WrPointer *at); /* took the centre */
void wr_symmetry_drag(WrApp *app, const WrPointer *at);
void wr_panel_symmetry(WrApp *app); /* on the canvas */

void wr_tool_pan_drag(WrApp *app, const WrPointer *at);

void wr_select_cancel(WrApp *app);

/* ---- views ---- */
void wr_canvas_view_draw(WrApp *app);    /* the picture */
void wr_canvas_view_overlay(WrApp *app); /* what lies on it */
void wr_patch_update(WrApp *app);        /* wish for what is wanted; take what is ready */
void wr_patch_draw(WrApp *app);
void wr_patch_overlay(WrApp *app);
bool wr_patch_press(WrApp *app, const WrPointer *at);
void wr_patch_drag(WrApp *app, const WrPointer *at);
void wr_patch_release(WrApp *app);
void wr_patch_wheel(WrApp *app, double steps);
void wr_patch_commit_zoom(WrApp *app, bool now);
void wr_patch_free(WrApp *app);
double wr_patch_next_time(const WrApp *app); /* clock at which update must run; 0: only on events */

/* ---- patch_paint.c: painting on the patch ---- */
bool wr_patch_paints(const WrApp *app); /* the pointer over the patch would paint */
/* Where the table is that lies under a pointer on the patch; false beside the object. */
bool wr_patch_paint_uv(WrApp *app, const WrPointer *at, double *u, double *v);
void wr_patch_paint_press(WrApp *app, const WrPointer *at);
void wr_patch_paint_drag(WrApp *app, const WrPointer *at);
void wr_patch_paint_release(WrApp *app, const WrPointer *at);
void wr_patch_paint_overlay(WrApp *app); /* the brush's outline on the object */
void wr_patch_paint_free(WrApp *app);

/* ---- panels ---- */
void wr_panel_menu(WrApp *app);
void wr_panel_options(WrApp *app);
void wr_panel_tools(WrApp *app);
void wr_panel_right(WrApp *app);
void wr_panel_brushes(WrApp *app, SDL_Rect room);
void wr_panel_brush(WrApp *app); /* the values of the brush in hand */
void wr_panel_scene(WrApp *app);
void wr_panel_material(WrApp *app); /* its lower parts */
void wr_panel_lights(WrApp *app);
/* Run a scene command whose value was being dragged; clears the line. */
void wr_scene_run(WrApp *app, WrText *line);
/* A number of the scene at `place` bytes, while it is being dragged. */
void wr_scene_live_number(WrApp *app, size_t place, double value);
void wr_panel_plan(WrApp *app);
void wr_panel_history(WrApp *app);
void wr_panel_layers(WrApp *app, SDL_Rect room);
void wr_panel_layers_forget(WrApp *app); /* its pictures */
void wr_layer_rename_start(WrApp *app, int index);
void wr_panel_seam(WrApp *app); /* on the canvas */
void wr_panel_status(WrApp *app);
void wr_panel_dialogs(WrApp *app);
void wr_dialog_unsaved(WrApp *app);
void wr_dialog_table(WrApp *app);
void wr_dialog_fill(WrApp *app);
void wr_dialog_grid(WrApp *app);
void wr_dialog_import(WrApp *app);
void wr_dialog_export(WrApp *app);
void wr_dialog_file(WrApp *app);
void wr_dialog_help(WrApp *app);
void wr_dialog_preset(WrApp *app); /* the name of a preset to be saved */
/* panel_tablet.c: the pressure curves that were kept go to the pens; the tester. */
void wr_tablet_start(WrApp *app);
void wr_tablet_free(WrApp *app);
void wr_dialog_tablet_open(WrApp *app);
void wr_dialog_tablet(WrApp *app);
void wr_dialog_close(WrApp *app);
/* The operation of an action "adjust_NAME", or NULL. */
const WrOpInfo *wr_action_op(const char *name);
void wr_dialog_adjust_open(WrApp *app, const WrOpInfo *op);
void wr_dialog_adjust(WrApp *app);
bool wr_adjust_by_name(WrApp *app, const char *name); /* "adjust_NAME"; see WrActionFamily */
void wr_dialog_select_open(WrApp *app, WrOutlineKind kind);
void wr_dialog_select(WrApp *app);
void wr_dialog_search(WrApp *app);
void wr_dialog_recover_open(WrApp *app); /* if there is anything to recover */
void wr_dialog_recover(WrApp *app);
void wr_recovery_free(WrRecovery *recovery); /* NULL is fine */
/* Where a dialog stands whose effect the views show. */
SDL_Rect wr_dialog_side(const WrApp *app);
void wr_dialog_open(WrApp *app, WrDialog dialog);
/* The buttons at the end of a dialog: 1 done, -1 cancelled (also by Escape), 0 neither. */
int wr_dialog_buttons(WrApp *app, const char *done, bool enabled);
/* "Takes about 12 s, 300 MB", where that is more than a moment, and how much of a trial of it is left; else "". */
#define WR_EXPECTATION 96
void wr_expectation(const WrApp *app, const char *line, char text[WR_EXPECTATION]);
/* The same as rows of their own, one of which is there in any case, so that buttons below stay where they are. */
void wr_panel_estimate(const WrApp *app, const char *line);

/* ---- settings_hand.c ---- */

void wr_settings_begin(WrApp *app); /* reads them */
/* Writes them if they changed, between gestures and once a second at most; and when that is due, 0: never. */
void wr_settings_tend(WrApp *app);
double wr_settings_next_time(const WrApp *app);
void wr_settings_end(WrApp *app); /* writes them at once */

/* ---- timing.c ---- */

/* WRINKLE_TIMING: a picture of the window took so long; and all of them, at the end. */
void wr_timing_note(WrApp *app, double seconds);
void wr_timing_tell(const WrApp *app);
