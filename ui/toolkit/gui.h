/* gui.h - widgets and 2D drawing of the window, as a plain C interface. Only the gui_imgui*.cpp files use Dear ImGui,
   and only gui_sdl_renderer.c draws its triangles with SDL. Immediate mode: between frame_begin and frame_end the panels call
   their widgets, and each call returns its result at once. One thread; one WrGui at a time.

   Sizes are pixels of the window unless a name contains `units`: a unit is a pixel at scale 1. */
#pragma once
#include "ui/toolkit/theme.h"

#include <SDL.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;

#ifdef __cplusplus
extern "C" {
#endif

typedef struct WrGui WrGui;
typedef struct WrRetainedFrame WrRetainedFrame;

/* The font files of text, bold text and icons. */
#define WR_GUI_FONT_FILES 3

/* scale: 0.75..4. font_files: [WR_GUI_FONT_FILES] from an earlier start, owned by the caller, who keeps them until
 * wr_gui_free; replaced if one is NULL or does not open. The caller owns the result; it must be freed before the renderer. */
WrGui *wr_gui_new(SDL_Renderer *renderer, double scale, char **font_files, WrError *err);
/* Replaces the files by those that Fontconfig finds; NULL: none. */
void wr_gui_find_fonts(char **files);
void wr_gui_free(WrGui *gui); /* NULL is allowed */
/* States of the folds (folds.h), owned by the caller, who keeps them until wr_gui_free. NULL: none are remembered. */
void wr_gui_use_folds(WrGui *gui, char **folds);
/* Change the scale; fonts are rasterised again. Not between frame_begin and frame_end. */
bool wr_gui_set_scale(WrGui *gui, double scale, WrError *err);

/* Pass an event to the widgets. The caller checks owns_point, holds_mouse and wants_text before it uses the event
   itself. */
void wr_gui_event(WrGui *gui, const SDL_Event *event);
/* Release held keys and buttons (the window lost the keyboard). */
void wr_gui_release_all(WrGui *gui);
/* True if a press there would reach a widget of the last frame. Correct even for events that arrive together with the
   motion before them. */
bool wr_gui_owns_point(const WrGui *gui, int x, int y);
/* Identifier of the widget, panel or menu at that pixel of the displayed frame. It differs if another widget is
   there, or another menu or dialog is open. 0: a view, and nothing is open. */
unsigned wr_gui_widget_at(const WrGui *gui, int x, int y);
bool wr_gui_holds_mouse(const WrGui *gui); /* a widget is being dragged */
bool wr_gui_wants_text(const WrGui *gui);  /* a text field has the keyboard focus */
/* True if a widget waits for a time (a tip, a drag that scrolls): draw again soon. */
bool wr_gui_has_pending_timer(const WrGui *gui);
/* True if the last frame does not show the effect of all events: a short press, a list or dialog that opens over
   several frames, a background being dimmed. Draw again now. */
bool wr_gui_unsettled(const WrGui *gui);
/* True if a menu, a list or a popup is open (not a dialog): it gets the keys. */
bool wr_gui_popup_open_now(const WrGui *gui);
/* Pointer shape requested by the widgets. */
SDL_SystemCursor wr_gui_cursor(const WrGui *gui);

/* Start a frame of width x height pixels, `seconds` after the last one. */
void wr_gui_frame_begin(WrGui *gui, int width, int height, double seconds);
/* Draw all recorded operations, widgets over views, and present the frame. */
void wr_gui_frame_end(WrGui *gui);
/* The frame in which views record their drawing (retained_frame.h), between begin and end. */
WrRetainedFrame *wr_gui_kept(const WrGui *gui);

/* Debian packages of missing fonts, as a sentence; NULL if none is missing. */
const char *wr_gui_missing_fonts(const WrGui *gui);

double wr_gui_scale(void);   /* pixels per unit */
int wr_gui_px(double units); /* units rounded to whole pixels */

/* ---- icons (UTF-8 of the icon font; short words without it: theme.h) ---- */
#define WR_ICON_BRUSH "\xef\x83\xa3"     /* f0e3 */
#define WR_ICON_HAND "\xef\x81\x81"      /* f041 arrow-all */
#define WR_ICON_ZOOM "\xef\x8d\x89"      /* f349 */
#define WR_ICON_PICK "\xef\x88\x8a"      /* f20a */
#define WR_ICON_PLAY "\xef\x90\x8a"      /* f40a */
#define WR_ICON_PAUSE "\xef\x8f\xa4"     /* f3e4 */
#define WR_ICON_DOWN "\xef\x8d\x9d"      /* f35d */
#define WR_ICON_CLOSE "\xef\x85\x96"     /* f156 */
#define WR_ICON_PLUS "\xef\x90\x95"      /* f415 */
#define WR_ICON_DELETE "\xef\x87\x80"    /* f1c0 */
#define WR_ICON_HELP "\xef\x8b\x97"      /* f2d7 */
#define WR_ICON_ALERT "\xef\x80\xa6"     /* f026 */
#define WR_ICON_FOLDER "\xef\x89\x8b"    /* f24b */
#define WR_ICON_OPENED "\xef\x85\x80"    /* f140 chevron-down */
#define WR_ICON_CLOSED "\xef\x85\x82"    /* f142 chevron-right */
#define WR_ICON_FILE "\xef\x88\xa4"      /* f224 */
#define WR_ICON_UP "\xef\x81\x9d"        /* f05d */
#define WR_ICON_CHECK "\xef\x84\xac"     /* f12c */
#define WR_ICON_CAMERA "\xef\x91\xa4"    /* f464 rotate-3d */
#define WR_ICON_EYE "\xef\x88\x88"       /* f208 */
#define WR_ICON_EYE_OFF "\xef\x88\x89"   /* f209 */
#define WR_ICON_LINK "\xef\x8c\xb9"      /* f339 link-variant */
#define WR_ICON_LOCK "\xef\x8c\xbe"      /* f33e */
#define WR_ICON_UNLOCK "\xef\x8d\x80"    /* f340 lock-open-outline */
#define WR_ICON_COPY "\xef\x86\x91"      /* f191 content-duplicate */
#define WR_ICON_MERGE "\xef\x83\xb8"     /* f0f8 call-merge */
#define WR_ICON_LOWER "\xef\x81\x85"     /* f045 arrow-down */
#define WR_ICON_RAISE "\xef\x81\x9d"     /* f05d arrow-up */
#define WR_ICON_RECT "\xef\x92\x89"      /* f489 selection */
#define WR_ICON_ELLIPSE "\xef\x95\x96"   /* f556 vector-circle */
#define WR_ICON_LASSO "\xef\x95\xa2"     /* f562 vector-selection */
#define WR_ICON_MORE "\xef\x87\x99"      /* f1d9 dots-vertical */
#define WR_ICON_SEARCH "\xef\x8d\x89"    /* f349 magnify */
#define WR_ICON_STAR "\xef\x93\x8e"      /* f4ce */
#define WR_ICON_STAR_OFF "\xef\x93\x92"  /* f4d2 star-outline */
#define WR_ICON_DROP "\xef\x96\x8c"      /* f58c water */
#define WR_ICON_FINGER "\xef\x8b\x87"    /* f2c7 hand-pointing-right */
#define WR_ICON_CLONE "\xef\x86\x8f"     /* f18f content-copy */
#define WR_ICON_BOX "\xef\x84\xb1"       /* f131 checkbox-blank-outline */
#define WR_ICON_ROUND "\xef\x84\xb0"     /* f130 checkbox-blank-circle-outline */
#define WR_ICON_POLYGON "\xef\x95\xa0"   /* f560 vector-polygon */
#define WR_ICON_CURVE "\xef\x95\x99"     /* f559 vector-curve */
#define WR_ICON_BUCKET "\xef\x89\xa6"    /* f266 format-color-fill */
#define WR_ICON_RAMP "\xef\x82\xb6"      /* f0b6 blur-linear */
#define WR_ICON_STAMP "\xee\x80\x80"     /* e000: drawn by gui_imgui_fonts.cpp */
#define WR_ICON_MIRROR "\xee\x80\x81"    /* e001: drawn by gui_imgui_fonts.cpp */
#define WR_ICON_ERASER "\xef\x87\xbe"    /* f1fe */
#define WR_ICON_TEXT "\xef\x97\xb4"      /* f5f4 format-title */
#define WR_ICON_CUBE "\xef\x86\xa6"      /* f1a6 */
#define WR_ICON_TUNE "\xef\x98\xae"      /* f62e */
#define WR_ICON_SAVE "\xef\x86\x93"      /* f193 content-save */
#define WR_ICON_BACK "\xef\x91\xa5"      /* f465 rotate-left */
#define WR_ICON_DOTS "\xef\x87\x98"      /* f1d8 dots-horizontal */
#define WR_ICON_WAND "\xef\x81\xa8"      /* f068 auto-fix */
#define WR_ICON_DICE "\xef\x87\x8e"      /* f1ce dice-5 */
#define WR_ICON_TRANSFORM "\xef\x97\x86" /* f5c6 vector-rectangle */
#define WR_ICON_GRID "\xef\x95\xb3"      /* f573 view-module */

/* ---- areas: fixed rectangles for widgets ---- */
typedef enum WrAreaKind {
    WR_AREA_BAR,    /* one row of widgets, vertically centred, never scrolls */
    WR_AREA_PANEL,  /* scrolls if its content is taller */
    WR_AREA_OVERLAY /* fits its content; over a view; rect x,y is the corner given by `anchor` */
} WrAreaKind;
void wr_gui_area_begin(const char *name, WrAreaKind kind, SDL_Rect rect, WrColour background);
void wr_gui_area_end(void);
/* A small area over a view. anchor_x, anchor_y: 0 puts its left (top) edge at x (y), 1 its right (bottom) edge. */
void wr_gui_overlay_begin(const char *name, int x, int y, double anchor_x, double anchor_y);
void wr_gui_overlay_end(void);

/* ---- floating panels: over the views, moved by their heading, resized at their corner. Areas between begin and end
   belong to it. ---- */
typedef struct WrFloat {
    SDL_Rect room; /* for the areas, pixels of the window */
    bool moving;   /* being dragged */
    bool dropped;  /* released at the pointer after a drag */
    bool docks;    /* its button was pressed */
    int x, y;      /* the pointer, pixels of the window */
} WrFloat;
/* rect: its place in pixels, which the user changes; it stays inside `bounds`. grab: begin as being dragged, because the
   pointer has torn it off. */
WrFloat wr_gui_float_begin(const char *label, SDL_Rect *rect, SDL_Rect bounds, bool grab);
void wr_gui_float_end(void);
/* A frame around a place into which a panel would be dropped, above everything. */
void wr_gui_drop_place(SDL_Rect rect);

/* ---- layout ---- */
void wr_gui_same_line(double gap_units);
void wr_gui_space(double units); /* downwards */
double wr_gui_available(void);   /* remaining width of this row in pixels */
void wr_gui_move_to(double x);   /* the next widget starts x pixels from the area's left edge */
double wr_gui_place(void);       /* present x position */
double wr_gui_width(void);       /* width of the area in pixels */
void wr_gui_push_id(int id);
void wr_gui_pop_id(void);
void wr_gui_disable(bool disabled); /* disable the following widgets until wr_gui_disable_end */
void wr_gui_disable_end(void);
/* Disable the following widgets with a reason, which becomes their tip; NULL: not disabled. */
void wr_gui_hold(const char *why);
void wr_gui_hold_end(void);

/* ---- text ---- Every text passed to a widget is shown translated (words.h), up to ##; its English form is the
   identifier. User-defined names and file names must not be translated: enclose them in wr_gui_as_it_is(true) and
   (false). */
void wr_gui_as_it_is(bool on);
/* Called for each text that is wider than its place, in pixels, if set; for tests. */
extern void (*wr_gui_cut)(const char *text, double width, double room);
/* If set, menus, lists, popups and folds are open, tips are translated, and no picture is drawn: all texts of the
   panels appear within a frame or two. For tests. */
extern bool wr_gui_reports_all;
/* If set, all folds are open. For tests. */
extern bool wr_gui_folds_open;
/* If set, everything works except that frames are not drawn. For tests. */
extern bool wr_gui_unseen;

typedef enum WrFont {
    WR_FONT_TEXT,
    WR_FONT_BOLD,
    WR_FONT_SMALL,
    WR_FONT_ICON,
    WR_FONT_COUNT
} WrFont;
void wr_gui_text(WrFont font, WrColour colour, const char *text);
void wr_gui_text_wrapped(WrFont font, WrColour colour, const char *text);
/* A wrapped text that comes and goes or changes, as a help or a warning: it always has the room of `lines` lines, so
   that the rows below stay in place. "" only keeps the room. */
void wr_gui_note(WrColour colour, const char *text, int lines);
void wr_gui_heading(const char *text); /* heading of a group of rows: small, capitals as given */
void wr_gui_label(const char *text);   /* left part of a row; the field follows in the same line */
double wr_gui_text_width(WrFont font, const char *text);
double wr_gui_line_height(WrFont font);
/* tip of the previous widget; shown when the pointer rests on it */
void wr_gui_tip(const char *text);

/* ---- widgets ---- */
/* Result of a widget for its value in this frame. */
typedef enum WrEdit {
    WR_EDIT_NONE,
    WR_EDIT_LIVE, /* being dragged: *value is the tentative value */
    WR_EDIT_DONE  /* the edit is finished */
} WrEdit;

typedef struct WrNumber {
    double low, high;           /* soft range: limits of a drag, low < high */
    double hard_low, hard_high; /* limits of typed values; both 0: the soft range */
    double reset;               /* value after Ctrl+click */
    int decimals;               /* digits after the point; -1: up to four significant digits */
    const char *unit;           /* "px", "deg"; may be NULL */
    bool logarithmic;           /* drag changes the value by equal ratios; low > 0 */
    const char *tip;            /* may be NULL */
} WrNumber;

/* A slider with text input: a drag moves it, a click types, Ctrl+click resets, Escape in a drag restores the value
   (LIVE with the old value). width <= 0: the rest of the row. */
WrEdit wr_gui_number(const char *id, double width, const WrNumber *spec, double *value);
bool wr_gui_choice(const char *id, double width, const char *const *items, int count, int *index);
/* Alternatives as buttons in a row; colours[i] (may be NULL) is shown while i is chosen. */
bool wr_gui_segments(const char *id, const char *const *items, const WrColour *colours, int count,
                     int *index);
/* The same, centred in the menu bar; and its width in pixels. */
bool wr_gui_bar_segments(const char *id, const char *const *items, int count, int *index);
double wr_gui_bar_segments_width(const char *const *items, int count);
/* Tabs across the area, in a smaller font without room, then in as many rows of 32 units as keep them apart. */
bool wr_gui_tabs(const char *id, const char *const *items, int count, int *index);
/* Number of rows of such tabs. */
int wr_gui_tab_rows(const char *const *items, int count, double width);
/* Indices of a tab of the previous tabs: dragged out of its bar in this frame, pressed with the right button; -1: none. */
int wr_gui_tab_torn(void);
int wr_gui_tab_menu(void);
WrEdit wr_gui_colour(const char *id, double width, double linear_rgb[3]);
bool wr_gui_check(const char *label, bool *value);
/* The next button or chip keeps this id while its label changes with its state, so that the keyboard's ring stays on
   it and a quick second click counts. Not for buttons whose new label requests a confirmation. */
void wr_gui_next_id(const char *id);
bool wr_gui_button(const char *label, bool primary);
/* A flat button with one icon, `units` wide and high. */
bool wr_gui_icon_button(const char *id, const char *icon, double units, bool selected);
/* A smaller icon button without background. */
bool wr_gui_glyph(const char *id, const char *icon, double units, WrColour colour);
/* A clickable text with an optional icon (may be NULL) on a dark chip. */
bool wr_gui_chip(const char *icon, const char *label);
/* A button that looks like a field: a text, and its keys at the right. */
bool wr_gui_find_button(const char *label, const char *keys, double width);
/* A single-line text field. focus: give it the keyboard focus now. True when Return was pressed. */
bool wr_gui_text_field(const char *id, double width, char *text, size_t size, bool focus);
/* A text area, `lines` tall; focus as in the text field. True when the text changed. */
bool wr_gui_text_area(const char *id, int lines, char *text, size_t size, bool focus);
/* A row of a list: 0 nothing, 1 clicked, 2 double-clicked. */
int wr_gui_list_row(const char *icon, const char *label, bool selected);
void wr_gui_list_begin(const char *id, double height);
void wr_gui_list_end(void);
/* A single-line text field with a hint while empty. True when the text changed. */
bool wr_gui_hint_field(const char *id, const char *hint, double width, char *text, size_t size);
/* A foldable heading of a section of a panel; true while its content is shown. Its state is remembered by the name of
   the area and its label. Ctrl or Alt and a click fold or unfold all sections of the area. */
bool wr_gui_fold(const char *label, bool open_at_first);
/* ---- pinned rows ---- Rows of pinnable areas (a label with its widgets, or a check) have a menu with Pin. Their names,
   "AREA/SECTION/LABEL", are in a list owned by the caller, NULL-terminated. */
void wr_gui_use_pins(WrGui *gui, char **pins, int most);
void wr_gui_pinnable(bool on); /* rows of the following areas */
bool wr_gui_has_pins(const char *area);
/* Between begin and end, all rows of that area's panel but the pinned ones are skipped. */
void wr_gui_pins_begin(const char *area);
void wr_gui_pins_end(void);
double wr_gui_content_height(void); /* of the area so far, pixels, with its padding */
/* A square picture button, `side` pixels: 0 nothing, 1 clicked, 2 pressed with the right button. marked: with a small
 * star. texture may be NULL. */
int wr_gui_tile(const char *id, SDL_Texture *texture, double side, bool selected, bool marked);
bool wr_gui_will_see(double side); /* part of a following tile would be visible */
/* In a bar: centre the following content, of that height in pixels, on the fields; and end that. */
void wr_gui_centre(double side);
void wr_gui_centre_end(double side);
void wr_gui_mark(WrColour colour); /* a small vertical bar of that colour, as tall as a field */
void wr_gui_width_at_least(double units); /* of the open popup */
/* True if the previous text field lost the keyboard focus in this frame, by Return, Escape or a click elsewhere. */
bool wr_gui_field_left(void);
/* A progress bar; fraction 0..1, below 0: unknown. width <= 0: the rest of the row. */
void wr_gui_progress(double width, double fraction);
/* A thin bar of a plot in the rest of the row; fraction 0..1 of its length. */
void wr_gui_bar(double fraction);
/* A dark square with coloured sides (left, right, top, bottom); for a tip. */
void wr_gui_edge_colours_square(const char *id, double units, const WrColour sides[4]);

/* ---- rows that contain widgets: between begin and end, wr_gui_row_set_cursor sets the next position ---- */
typedef struct WrRow {
    double top, height; /* pixels of the window */
    double pointer_y;   /* pixels of the window */
    /* released over the row without a drag; for the second time in quick succession */
    bool clicked, doubled;
    bool menu;     /* pressed with the right button */
    bool dragging; /* pressed and moved; near the area's edge it scrolls */
    bool dropped;  /* released after a drag, which Escape has not cancelled */
    bool ringed;   /* it has the ring of the keyboard focus */
    bool reached;  /* the ring came to it from another row, by Up or Down; */
    bool extends;  /* with Shift */
} WrRow;
typedef enum WrRowLook {
    WR_ROW_PLAIN,
    WR_ROW_SELECTED,
    WR_ROW_CHOSEN /* one of several, beside the selected row */
} WrRowLook;
/* A row across the whole area. */
WrRow wr_gui_row_begin(int id, double height_units, WrRowLook look);
/* x: pixels from the row's left edge. tall: height of the following content in pixels; 0: a line of text. */
void wr_gui_row_set_cursor(double x, double tall);
void wr_gui_row_see(void);     /* right after begin: scroll the list until the row is visible */
double wr_gui_row_width(void); /* pixels */
void wr_gui_row_end(void);
/* A line across the area at y pixels of the window, from x pixels right of its left edge, as the drop position of a
   drag. */
void wr_gui_drop_line(double x, double y);
/* A frame around a row at y, into which a drag drops. */
void wr_gui_drop_frame(double y, double height);
/* A picture (NULL: none) beside the pointer, above all widgets. x, y: the pointer, pixels of the window. */
void wr_gui_carry(SDL_Texture *texture, double side, double *x, double *y);
/* The pointer holds the previous widget. */
bool wr_gui_held(void);
/* Ends the pointer's hold of a widget without effect. */
void wr_gui_let_go(void);
/* Text truncated with an ellipsis at `width` pixels. */
void wr_gui_text_cut(WrFont font, WrColour colour, const char *text, double width);
/* Text wrapped at `width` pixels. */
void wr_gui_text_within(WrFont font, WrColour colour, const char *text, double width);
/* A picture of w x h pixels with a thin border. */
void wr_gui_image(SDL_Texture *texture, double w, double h);
/* A picture as a button; chosen: with a frame around it. */
bool wr_gui_image_button(const char *id, SDL_Texture *texture, double w, double h, bool chosen);
/* Fill w x h pixels with a colour, using the picture's alpha as mask; NULL only reserves the space. */
void wr_gui_ink(SDL_Texture *texture, double w, double h, WrColour colour);
/* A button that looks like a combo box, `width` pixels wide, with truncated label; the caller opens the list. */
bool wr_gui_list_button(const char *id, const char *label, double width);

/* ---- menus, popups, dialogs: if begin returns true, the popup is open, and end must follow ---- */
/* tight: little room. Returns the height in pixels. */
double wr_gui_menu_bar_begin(bool tight);
void wr_gui_menu_bar_end(void);
bool wr_gui_menu_begin(const char *label);
void wr_gui_menu_end(void);
bool wr_gui_menu_item(const char *label, const char *keys, bool checked, bool enabled);
void wr_gui_menu_separator(void);
void wr_gui_popup_open(const char *id);
bool wr_gui_popup_begin(const char *id);
void wr_gui_popup_end(void);
void wr_gui_popup_close(void); /* closes the popup being drawn */
/* A modal dialog in the middle of the window. `open` true shows it. Escape or a click beside it does not close it:
   the caller decides. */
bool wr_gui_dialog_begin(const char *title, double width_units);
/* A modal dialog at a given place, at least that tall, without dimming: the views show its effect. */
bool wr_gui_dialog_begin_at(const char *title, SDL_Rect place);
void wr_gui_dialog_end(void);
bool wr_gui_escape_pressed(void); /* in this frame */
bool wr_gui_return_pressed(void); /* in this frame, and not used by a text field */
bool wr_gui_letter_pressed(SDL_Scancode key);
/* in this frame, key repeats included; also while a text field is active */
bool wr_gui_key_pressed(SDL_Scancode key);

/* ---- pads: areas for custom drawing and pointing ---- */
typedef struct WrPad {
    double x, y, w, h; /* pixels of the window */
    /* pixels of the window; outside the window its last position inside */
    double pointer_x, pointer_y;
    bool hovered; /* the pointer is over it */
    bool pressed, held,
        released; /* left button on the pad: pressed, held, released at the pointer */
} WrPad;
/* w x h pixels; w <= 0: the rest of the row. Until pad_end the drawing functions below draw into it, clipped. */
WrPad wr_gui_pad_begin(const char *id, double w, double h);
void wr_gui_pad_end(void);
/* A disc of that radius in pixels, in the middle of a line of that height in pixels. */
void wr_gui_swatch(WrColour colour, double radius, double tall);
/* Group widgets beside the previous one: after wr_gui_same_line. */
void wr_gui_group_begin(void);
void wr_gui_group_end(void);

/* A frame around a part of the window, above everything, for this frame. */
void wr_gui_spotlight(const SDL_Rect *part);

/* ---- drawing on the views, below the panels ---- */
void wr_gui_draw_clip(SDL_Rect rect);
void wr_gui_draw_unclip(void);
void wr_gui_draw_line(double x0, double y0, double x1, double y1, WrColour colour, double width);
void wr_gui_draw_rect(double x, double y, double w, double h, WrColour colour, double width);
void wr_gui_draw_fill(double x, double y, double w, double h, WrColour colour, double rounding);
/* A filled quad; corners in order around it. */
void wr_gui_draw_quad(const double x[4], const double y[4], WrColour colour);
void wr_gui_draw_circle(double x, double y, double radius, WrColour colour, double width);
void wr_gui_draw_disc(double x, double y, double radius, WrColour colour);
/* An arc, clockwise from the top; turns 0..1. */
void wr_gui_draw_arc(double x, double y, double radius, double turns, WrColour colour,
                     double width);
void wr_gui_draw_text(double x, double y, WrFont font, WrColour colour, const char *text);

#ifdef __cplusplus
}
#endif
