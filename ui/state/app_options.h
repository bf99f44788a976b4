/* app_options.h - what a window is opened with. */
#pragma once
#include "command/session_internal.h"

#include <stdbool.h>

typedef struct WrText WrText;

typedef struct WrAppOptions {
    WrSession
        *session; /* borrowed; with outputs on. If file_given, what was asked for is open in it */
    const char *file;  /* of file_given, and nothing more was asked for; borrowed; NULL: none */
    bool file_given;   /* false: the window opens the starter document (samples/bricks.wrinkle) */
    int threads;       /* of the preview, as in wr_pool_new */
    const char *isa;   /* kernels of the preview, as in wr_renderer_new; NULL: auto */
    int width, height; /* of the window, pixels; 0: as it was last time, at first 1440 x 900 */
    const volatile int *cancel; /* may be NULL; non-zero: a measurement stops */
    WrText *notes; /* where the session's note sink puts its lines, each ended by '\n'; the window
                           shows and clears them. May be NULL */
} WrAppOptions;
