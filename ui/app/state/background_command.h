/* background_command.h - long commands on a worker thread, while the window stays responsive.

   While a command runs, app->busy is not NULL, and app->session is a snapshot of the session (wr_session_snapshot),
   from which the window reads. Only the worker has access to the session itself. A snapshot rejects all commands, so
   a missing check causes an error and not a data race. User actions meanwhile are handled in three ways. Lines with
   the same meaning afterwards, such as a layer's visibility, strokes, undo and redo are queued and run in order when the
   command ends. Other changes of the document are refused, with a note in the status bar. Everything else is done at once.
   The kind is set by an action's row (`edits`, `waits`), a tool's row (`meanwhile`) and, for lines, by ui/app/state/run_line.c.

   All frames are drawn by the main loop: it is never entered recursively from within a frame. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/toolkit/gui.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrSession WrSession;

typedef enum WrBusyKind {
    WR_BUSY_EDIT,    /* the document may be changed or written */
    WR_BUSY_ANOTHER, /* the document is replaced: edits of its layers cannot be queued */
    WR_BUSY_TEND     /* background upkeep: nothing is refused, all edits are queued */
} WrBusyKind;

/* ---- running ---- */

/* Run a command line in the background; a failure becomes a message. Inside a frame the call returns true after a
   moment even if the command is still running. Queued or refused while another command runs. */
bool wr_app_run_line(WrApp *app, const char *line);
bool wr_app_run_linef(WrApp *app, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Call work(session, ctx) on another thread and return its result when it is done. After a moment the status bar
   shows the text `what`, progress, remaining time and Cancel. Not allowed inside a frame
   (ui/app/state/action.h). Waits for background upkeep; fails while another command runs. */
typedef bool WrBusyWork(WrSession *session, void *ctx, WrError *err);
bool wr_busy_run(WrApp *app, WrBusyKind kind, const char *what, WrBusyWork *work, void *ctx,
                 WrError *err);
/* Start background upkeep (WR_BUSY_TEND) and return. It may still run after the call, so *ctx must stay valid (NULL
   is allowed); failures are not reported. Does nothing while a command runs. */
void wr_background_upkeep_start(WrApp *app, const char *what, WrBusyWork *work, void *ctx);
/* Show the reason of the last failure: an error, or a note if the user cancelled. */
void wr_busy_fail(WrApp *app, const char *what, const WrError *err);
/* Run the line of the edit preview on the current document. If the preview has finished, its result is used. */
void wr_app_run_tried(WrApp *app, const char *line);
/* For a value of a dialog: preview the line while the value is dragged, and run it afterwards. */
void wr_app_try_command(WrApp *app, WrEdit edit, const char *line);
/* Run a command that may take long, now or after the current frame. */
void wr_app_run_slow(WrApp *app, const char *line);
bool wr_app_line_waits(const WrApp *app); /* a line is queued to run after this frame */

/* ---- during a background command ---- */

/* True if the running command refuses changes of the document. */
bool wr_busy_refuses(const WrApp *app);
/* True if it has done so for longer than a moment: widgets of refused actions are then disabled. */
bool wr_busy_greys(const WrApp *app);
/* Disable the widgets between these two calls, with a tip on the reason, while changes are refused. */
void wr_busy_hold(const WrApp *app);
void wr_busy_hold_end(void);
/* Return true, with a note in the status bar, if changes of the document are refused now. */
bool wr_busy_refuse(WrApp *app);
/* Close the window when the command is done; false if no command runs. */
bool wr_busy_close(WrApp *app);
/* True if strokes and layer commands can be queued behind the running command. */
bool wr_busy_lets_wait(const WrApp *app);
/* Wait until no background upkeep runs and queued actions are done. Does nothing inside a frame. */
void wr_busy_settle(WrApp *app);

/* Queue an action for the end of the running command, in order: late(app, text, false). If it is dropped, late(app,
   text, true) must only free its data. of_layers: drop the action if the layers have changed by then. `words` is its
   name for the user. */
typedef void WrBusyLate(WrApp *app, const char *text, bool dropped);
void wr_busy_put_off(WrApp *app, const char *words, WrBusyLate *late, const char *text,
                     bool of_layers);
bool wr_busy_runs_queue(const WrApp *app); /* true while a queued action runs */
/* Remove the newest queued action of that kind and text; it is not called. */
void wr_busy_take_back(WrApp *app, WrBusyLate *late, const char *text);

/* ---- for the main loop ---- */

/* True in the first moment of a command: events stay in the queue, so that they keep their order. */
bool wr_busy_is_young(const WrApp *app);
/* Finish completed work and run queued actions. Called before each event. */
void wr_busy_update(WrApp *app);
/* Handle an event while a command runs: true if it must not reach the widgets. */
bool wr_busy_event(WrApp *app, const SDL_Event *event);
/* Handle it after the widgets: true if the event only moved a component's view. */
bool wr_busy_view_event(WrApp *app, const SDL_Event *event);
/* Draw progress: of an opening over the canvas, of other commands in place of the status line. True if the latter. */
bool wr_busy_bar(WrApp *app);
void wr_busy_stop(WrApp *app); /* the window closes: cancel the running command */
void wr_busy_free(WrApp *app);
