/* app_options.h - start options of a window. */
#pragma once
#include "command/session_internal.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

typedef struct WrAppOptions {
    /* borrowed; output commands enabled. If file_given, the requested file is open in it, or `open` opens it */
    WrSession *session;
    /* Open the requested document; called on a worker thread while the window is shown; NULL: it is open already */
    bool (*open)(WrSession *session, void *ctx, WrError *err);
    void *open_ctx;
    const char
        *file; /* with open: requested file, if nothing else was requested; borrowed; NULL: none */
    const char *brush; /* .myb file of the brush at the start; borrowed; NULL: the last brush */
    bool file_given;   /* false: the window opens samples/starters/bricks.wrinkle */
    /* live export from the start: folder of the maps, set or kind (NULL: the document's), and the file
       whose name they have; borrowed; live_folder NULL: off */
    const char *live_folder, *live_as, *live_file;
    int threads;                /* for the preview, as in wr_pool_new */
    const char *isa;            /* kernel set of the preview, as in wr_renderer_new; NULL: auto */
    int width, height;          /* of the window, pixels; 0: the last size, at first 1440 x 900 */
    const volatile int *cancel; /* may be NULL; non-zero: stop a measurement */
    /* buffer that receives the session's notes, each line ended by '\n'; the window shows and
       clears them. May be NULL */
    WrText *notes;
} WrAppOptions;
