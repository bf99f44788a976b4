/* gui_page.h - a field that scrolls and is drawn on by hand, of any height: for texts. And a narrow list beside it. */
#pragma once
#include "ui/toolkit/gui.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct WrGuiPage {
    double x, y,
        w; /* the upper left corner of what is drawn, as it is scrolled, and its width: pixels */
    double top, bottom; /* what of it is seen: pixels of the window */
    double scroll;      /* pixels that it is scrolled by */
    double pointer_x, pointer_y;
    bool hovered, clicked; /* the pointer is on it; its left button went down */
} WrGuiPage;

/* wide, tall: pixels; wide <= 0: what is left of the row. Until the end drawing goes to it, clipped. */
WrGuiPage wr_gui_page_begin(const char *id, double wide, double tall);
void wr_gui_page_image(SDL_Texture *texture, double x, double y, double w, double h);
/* height: of all that can be drawn, pixels. scroll: so far from now on; below 0: as it is. */
void wr_gui_page_end(double height, double scroll);
/* As wr_gui_list_begin, so many pixels wide; ends with wr_gui_list_end. */
void wr_gui_column_begin(const char *id, double wide, double tall);

#ifdef __cplusplus
}
#endif
