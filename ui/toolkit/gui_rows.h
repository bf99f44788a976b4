/* gui_rows.h - the rows of panels by their names: a list of all rows that a function draws, and a highlight of one row. */
#pragma once
#include <stdbool.h>

typedef struct WrGui WrGui;

#ifdef __cplusplus
extern "C" {
#endif

typedef enum WrRowText {
    WR_ROW_SECTION, /* heading or foldable heading of the following rows */
    WR_ROW_LABEL,   /* of a row or a check box */
    WR_ROW_BUTTON,
    WR_ROW_CHOICE, /* one of the alternatives of the row before it */
    WR_ROW_TIP,    /* of the row before it */
    WR_ROW_MENU,   /* a menu begins; reported only while all menus are open (wr_gui_reports_all) */
    WR_ROW_MENU_END
} WrRowText;

/* text: as passed to the widget; valid during the call. */
typedef void WrRowReport(void *ctx, WrRowText kind, const char *text);

/* Draw off screen, in a frame of its own without input, and report all rows, folded ones too. Names given by the user are
   left out. Not within a frame. width, height: pixels of the window. */
void wr_gui_list_rows(WrGui *gui, int width, int height, void (*draw)(void *ctx),
                      WrRowReport *report, void *ctx);
/* A row whose label is not a widget's own: its name before it, and the last item after it. */
void wr_gui_name_row(const char *label);
void wr_gui_name_item(const char *label);
/* True while rows are listed: no background work should be started for them. */
bool wr_gui_lists_rows(void);

/* Unfold the section, scroll to the first row of that label in it, and frame the row for some seconds. section: "" for any.
   If the row is not shown within some frames, the section's heading is framed. */
void wr_gui_light_row(WrGui *gui, const char *section, const char *label);
/* Seconds until the frame has to be removed by another picture; below 0: there is no frame. */
double wr_gui_light_left(const WrGui *gui);
/* The framed row of the last picture, as x, y, width, height in pixels; false: there is none. For tests. */
bool wr_gui_lit_row(const WrGui *gui, float place[4]);
/* True if the highlight waits for a row of that label, so that its section can open. */
bool wr_gui_light_waits(const char *label);

#ifdef __cplusplus
}
#endif
