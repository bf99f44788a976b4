/* gui_page.h - scrolling area for custom drawing of any height, used for texts, with a narrow list beside it. */
#pragma once
#include "ui/toolkit/gui.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct WrGuiPage {
    double x, y, w; /* upper left corner of the content after scrolling, and its width: pixels */
    double top, bottom; /* visible range: pixels of the window */
    double scroll;      /* scroll offset in pixels */
    double pointer_x, pointer_y;
    bool hovered, clicked; /* the pointer is over it; the left button was pressed */
} WrGuiPage;

/* wide, tall: pixels; wide <= 0: the rest of the row. Until the end, drawing goes to it, clipped. */
WrGuiPage wr_gui_page_begin(const char *id, double wide, double tall);
/* Let the keys reach a drawn place of the page; index: unlike that of others on the page. True if they press it. */
bool wr_gui_page_stop(int index, double x, double y, double w, double h);
void wr_gui_page_image(SDL_Texture *texture, double x, double y, double w, double h);
/* height: of the whole content, pixels. scroll: new offset; below 0: unchanged. */
void wr_gui_page_end(double height, double scroll);
/* wr_gui_list_begin with a width in pixels; ends with wr_gui_list_end. */
void wr_gui_column_begin(const char *id, double wide, double tall);

#ifdef __cplusplus
}
#endif
