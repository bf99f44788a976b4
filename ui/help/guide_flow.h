/* guide_flow.h - a page of the guide laid out in a width, and drawn. */
#pragma once
#include "ui/toolkit/gui_page.h"
#include "ui/help/guide_page.h"
#include "ui/help/guide_picture.h"

#include "base/array.h"

#include <stdbool.h>

typedef struct WrGuidePlace {
    double y, height;              /* pixels, from the top of the page */
    double column[WR_GUIDE_CELLS]; /* of a row: widths */
} WrGuidePlace;

/* Where each block stands, for one page in one width. */
typedef struct WrGuideLayout {
    const WrGuidePage *page; /* borrowed; NULL: none yet */
    double width, scale;
    int pictures;                  /* that were there when it was made */
    WR_ARRAY(WrGuidePlace) places; /* one a block */
    double height;
} WrGuideLayout;

void wr_guide_layout_fini(WrGuideLayout *layout);
/* Bring it up to date. True if anything moved. */
bool wr_guide_layout(WrGuideLayout *layout, const WrGuidePage *page, double width,
                     WrGuidePictures *pictures);
/* Draw what is seen of it; marked: a block that is pointed out, -1: none. Returns the target of the link under
 * the pointer, within the page, and its length, or NULL. */
const char *wr_guide_draw(const WrGuideLayout *layout, const WrGuiPage *field, int marked,
                          WrGuidePictures *pictures, int *length);
