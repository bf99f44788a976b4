/* busy.h - what may take long runs beside the window, which goes on as ever.

   While it runs, app->busy is not NULL, and app->session is a still of the session as it was (wr_session_snapshot): all that
   the window reads, it reads there. Nobody but the worker has the session itself, and a still refuses to run anything, so
   that whatever a part forgets is an error and no race. Of what the user asks for meanwhile, a line that means the same
   afterwards, such as a layer's eye, and a stroke are put off and done in order when the work is done; what else would
   change the document is refused, and the bar says so; all other things are done at once. An action's row (`edits`), a
   tool's (`meanwhile`) and, for lines, ui/state/run_line.c say which is which.

   Each picture of the window is one of the ordinary loop's: it is never entered from within another picture. */
#pragma once
#include "ui/state/app_state.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrSession WrSession;

typedef enum WrBusyKind {
    WR_BUSY_EDIT,    /* the document may be changed, or written */
    WR_BUSY_ANOTHER, /* it becomes another one: what is asked of its layers cannot wait */
    WR_BUSY_TEND     /* nobody asked for it: nothing is refused, all waits */
} WrBusyKind;

/* ---- running ---- */

/* Run a command line beside the window; a failure becomes a message. Inside a picture of the window what takes longer
   than a moment is still under way afterwards: then it is true. Put off, or refused, while something runs. */
bool wr_app_run_line(WrApp *app, const char *line);
bool wr_app_run_linef(WrApp *app, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Call work(session, ctx), on another thread, and come back when it is done: with what it said. What takes longer
   than a moment shows `what`, a bar, how long it will still take, and Cancel. Not inside a picture of the window
   (ui/state/deferred_actions.h); waits for what nobody asked for, fails while something else runs. */
typedef bool WrBusyWork(WrSession *session, void *ctx, WrError *err);
bool wr_busy_run(WrApp *app, WrBusyKind kind, const char *what, WrBusyWork *work, void *ctx,
                 WrError *err);
/* The same as WR_BUSY_TEND, but nobody waits: it may still be under way afterwards, so *ctx must live on (NULL is fine),
   and no failure is told. Does nothing while something runs. */
void wr_busy_aside(WrApp *app, const char *what, WrBusyWork *work, void *ctx);
/* Say why the newest one failed: an error, or a note where it was the user who gave it up. */
void wr_busy_fail(WrApp *app, const char *what, const WrError *err);
/* Run a line that is being tried just so, on the document as it is: where the trial has made it, that is taken
   instead of being made again. */
void wr_app_run_tried(WrApp *app, const char *line);
/* Run a command that may take long, at once or after the picture of the window that is being made. */
void wr_app_run_slow(WrApp *app, const char *line);
bool wr_app_line_waits(const WrApp *app); /* one is to be run after this picture */

/* ---- meanwhile ---- */

/* Something runs for which what changes the document is refused. */
bool wr_busy_refuses(const WrApp *app);
/* The same, and for longer than a moment: what would be refused is grey. */
bool wr_busy_greys(const WrApp *app);
/* Widgets that change the document stand between these two: grey, and why, while it must be. */
void wr_busy_hold(const WrApp *app);
void wr_busy_hold_end(void);
/* True, and the bar says so, if what changes the document is refused now. */
bool wr_busy_refuse(WrApp *app);
/* It closes when this is done; false if nothing runs. */
bool wr_busy_close(WrApp *app);
/* Whether strokes and lines of layers can wait for what runs. */
bool wr_busy_lets_wait(const WrApp *app);
/* Come back when nothing that nobody asked for runs, and what waited is done. Does nothing inside a picture. */
void wr_busy_settle(WrApp *app);

/* To be done when the work is, in order: late(app, text, false); or, where it was given up, never: late(app, text, true),
   which only forgets. of_layers: it means nothing if the layers are others by then. `words` is what the user reads. */
typedef void WrBusyLate(WrApp *app, const char *text, bool dropped);
void wr_busy_put_off(WrApp *app, const char *words, WrBusyLate *late, const char *text,
                     bool of_layers);
/* The newest of them is wished for no more: it goes without being called. */
void wr_busy_take_back(WrApp *app, WrBusyLate *late, const char *text);

/* ---- for the loop ---- */

/* What began a moment ago: events are left where they are, so that what is pressed keeps its order. */
bool wr_busy_is_young(const WrApp *app);
/* End what is done, do what waited. Before each event. */
void wr_busy_tend(WrApp *app);
/* An event while something runs: true if it is not for the widgets. */
bool wr_busy_event(WrApp *app, const SDL_Event *event);
/* And after those had it: true if a part's view was only looked at by it. */
bool wr_busy_look(WrApp *app, const SDL_Event *event);
/* Widgets: in the place of the status line; false if there is nothing to tell. */
bool wr_busy_bar(WrApp *app);
void wr_busy_stop(WrApp *app); /* the window ends: give up what runs */
void wr_busy_free(WrApp *app);
