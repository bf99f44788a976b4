/* guide_flow.h - layout and drawing of a guide page in a given width. */
#pragma once
#include "ui/toolkit/gui_page.h"
#include "ui/panels/help/guide_page.h"

#include "base/array.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrGuidePictures WrGuidePictures;

typedef struct WrGuidePlace {
    double y, height;              /* pixels, from the top of the page */
    double column[WR_GUIDE_CELLS]; /* of a row: column widths */
} WrGuidePlace;

/* Positions of the blocks of one page in one width. */
typedef struct WrGuideLayout {
    const WrGuidePage *page; /* borrowed; NULL: none yet */
    double width, scale;
    int pictures;                  /* pictures loaded at the time of the layout */
    WR_ARRAY(WrGuidePlace) places; /* one per block */
    double height;
} WrGuideLayout;

void wr_guide_layout_fini(WrGuideLayout *layout);
/* Update the layout. True if a position changed. */
bool wr_guide_layout(WrGuideLayout *layout, const WrGuidePage *page, double width,
                     WrGuidePictures *pictures);
/* Position of a pixel inside the Run button of a command's block. */
void wr_guide_run_at(const WrGuideLayout *layout, const WrGuiPage *field, int block, double *x,
                     double *y);
/* Draw the visible part; marked: highlighted block, -1: none. Returns the target of the link under the pointer,
 * within the page, or NULL. */
const char *wr_guide_draw(const WrGuideLayout *layout, const WrGuiPage *field, int marked,
                          WrGuidePictures *pictures);

/* ---- pictures of the guide, loaded in the background ---- */

/* done_event: an SDL event type, pushed when another picture is loaded. */
WrGuidePictures *wr_guide_pictures_new(SDL_Renderer *renderer, Uint32 done_event);
/* NULL is allowed; must be freed before the renderer */
void wr_guide_pictures_free(WrGuidePictures *pictures);
