/* display_view.h - display transforms of colour configurations (OpenColorIO): from linear light to codes of a display.

   The picture library computes them; it is loaded with the first view. Views are shared, immutable, and kept until the
   program ends, so scenes copy the pointer. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

/* Names as in the command `tone`; texts are never NULL. */
typedef struct WrDisplayViewNames {
    const char *config;  /* absolute path of config.ocio; "": that of $OCIO */
    const char *display; /* "": the configuration's default */
    const char *view;
    const char *space; /* colour space of light; "": the role scene_linear */
} WrDisplayViewNames;

typedef struct WrDisplayView {
    WrDisplayViewNames names;
    bool ready; /* false: only named; pictures are as without a view */
} WrDisplayView;

/* The view, loaded again if the file changed. NULL and an error that lists the configuration's displays, views or
   colour spaces. */
const WrDisplayView *wr_display_view_load(const WrDisplayViewNames *names, WrError *err);
/* A view that is not ready, for a document whose configuration may not be read. */
const WrDisplayView *wr_display_view_named(const WrDisplayViewNames *names);

/* Converts colours [count][3] in place: linear light to codes, 0..1 on the display. A ready view; any thread. */
void wr_display_view_apply(const WrDisplayView *view, float *rgb, int count);
