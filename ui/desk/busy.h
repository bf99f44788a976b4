/* busy.h - what may take long runs beside the window. */
#pragma once
#include "ui/desk/desk.h"

#include <stdbool.h>

typedef struct WrError WrError;

/* Run a command line, as wr_busy_run does; a failure becomes a message. */
bool wr_app_run_line(WrApp *app, const char *line);
bool wr_app_run_linef(WrApp *app, const char *format, ...) __attribute__((format(printf, 2, 3)));
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
