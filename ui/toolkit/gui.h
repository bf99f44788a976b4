/* gui.h - widgets and drawing of the window as plain C.
   The gui_imgui*.cpp files behind it are the only ones that know Dear ImGui, and gui_sdl.c the only one
   that hands its triangles to SDL. Immediate mode: between frame_begin and frame_end the panels say what
   they hold, and each widget answers at once. One thread; one WrGui at a time.

   Sizes are pixels of the window unless a name says `units`: a unit is a pixel at scale 1. */
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

/* scale: 0.75..4. The caller owns it; it must be freed before the renderer. */
WrGui *wr_gui_new(SDL_Renderer *renderer, double scale, WrError *err);
void wr_gui_free(WrGui *gui); /* NULL is fine */
/* Another scale; text is drawn anew at that size. Not between frame_begin and frame_end. */
bool wr_gui_set_scale(WrGui *gui, double scale, WrError *err);

/* Hand over an event. The caller looks at owns_point, holds_mouse and wants_text before it uses it
   itself. */
void wr_gui_event(WrGui *gui, const SDL_Event *event);
/* Forget held keys and buttons (the window lost the keyboard). */
void wr_gui_release_all(WrGui *gui);
/* A press there would go to a widget: by the windows of the last frame, so that it is right even for
   events that arrive in one bundle with the motion before them. */
bool wr_gui_owns_point(const WrGui *gui, int x, int y);
/* A name of the widget, the panel or the menu at that pixel of the picture on the screen; another one when another thing
   stands there, or another menu or dialog is open. 0: a view, and nothing is open. */
unsigned wr_gui_widget_at(const WrGui *gui, int x, int y);
/* A number field that was clicked is typed into without waiting for a double click. True if there is one. */
bool wr_gui_type_now(WrGui *gui);
bool wr_gui_holds_mouse(const WrGui *gui); /* a widget is being dragged */
bool wr_gui_wants_text(const WrGui *gui);  /* a text field has the keyboard */
/* A widget waits for time to pass (a click that may become a double click, a tip): draw again soon. */
bool wr_gui_busy(const WrGui *gui);
/* The last picture does not show all that the events so far come to: a press that was let go at once, a list
   or a dialog that opens over several pictures, a ground that is still being dimmed. Draw again now. */
bool wr_gui_unsettled(const WrGui *gui);
/* A menu, a list or a popup is open, dialogs not counted: the keys are for it. */
bool wr_gui_popup_open_now(const WrGui *gui);
/* The pointer's shape that the widgets ask for. */
SDL_SystemCursor wr_gui_cursor(const WrGui *gui);

/* A new picture of the window, width x height pixels, so many seconds after the last one. */
void wr_gui_frame_begin(WrGui *gui, int width, int height, double seconds);
/* Draws what was noted since then, widgets on top of views, and puts it on the screen. */
void wr_gui_frame_end(WrGui *gui);
/* The picture that views note what they draw for (retained_frame.h), between begin and end. */
WrRetainedFrame *wr_gui_kept(const WrGui *gui);

/* The Debian packages of fonts that were not found, as a sentence; NULL if none is missing. */
const char *wr_gui_missing_fonts(const WrGui *gui);

double wr_gui_scale(void);   /* pixels a unit */
int wr_gui_px(double units); /* units as whole pixels */

/* ---- icons (UTF-8 of the icon font; short words where it is missing: gui_icons.h) ---- */
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
#define WR_ICON_FILE "\xef\x88\xa4"      /* f224 */
#define WR_ICON_UP "\xef\x81\x9d"        /* f05d */
#define WR_ICON_CHECK "\xef\x84\xac"     /* f12c */
#define WR_ICON_CAMERA "\xef\x91\xa4"    /* f464 rotate-3d */
#define WR_ICON_EYE "\xef\x88\x88"       /* f208 */
#define WR_ICON_EYE_OFF "\xef\x88\x89"   /* f209 */
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
#define WR_ICON_STAMP "\xee\x80\x80"     /* e000: drawn by gui_imgui_icons.cpp */
#define WR_ICON_MIRROR "\xee\x80\x81"    /* e001: the same */
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

/* ---- areas: fixed rectangles that hold widgets ---- */
typedef enum WrAreaKind {
    WR_AREA_BAR,   /* one row of widgets, centred in height, never scrolls */
    WR_AREA_PANEL, /* scrolls when its content is taller */
    WR_AREA_OVERLAY /* fits its content; lies on a view; rect x,y is the corner that `anchor` names */
} WrAreaKind;
void wr_gui_area_begin(const char *name, WrAreaKind kind, SDL_Rect rect, WrColour background);
void wr_gui_area_end(void);
/* A small area on a view. anchor_x, anchor_y: 0 puts its left (top) edge at x (y), 1 its right
   (bottom) edge. */
void wr_gui_overlay_begin(const char *name, int x, int y, double anchor_x, double anchor_y);
void wr_gui_overlay_end(void);

/* ---- placing ---- */
void wr_gui_same_line(double gap_units);
void wr_gui_space(double units); /* downwards */
double wr_gui_available(void);   /* width left on this row, in pixels */
void wr_gui_move_to(double x);   /* the next widget starts x pixels from the area's left edge */
double wr_gui_place(void);       /* where that would be without it */
double wr_gui_width(void);       /* of the area, in pixels */
void wr_gui_push_id(int id);
void wr_gui_pop_id(void);
void wr_gui_disable(bool disabled); /* grey out what follows; ends with wr_gui_enable */
void wr_gui_enable(void);
/* The same with a reason, which is the tip of all of it; NULL: not at all. */
void wr_gui_hold(const char *why);
void wr_gui_hold_end(void);

/* ---- text ----
   Every text that a widget is given is shown in the user's language (words.h), by what stands before ##, and known by the
   English one. Names that the user gave, and files, are no words: they stand between true and false. */
void wr_gui_as_it_is(bool on);
/* Told of each text that is wider than its place, in pixels, while it is set; for tests. */
extern void (*wr_gui_cut)(const char *text, double width, double room);
/* While it is set menus, lists, popups and folds are open, tips are looked up, and no picture is drawn: all that the
   panels can say is said in a frame or two. For tests. */
extern bool wr_gui_tells_all;
/* While it is set all goes on as ever, but for the picture, which nobody draws. For tests. */
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
void wr_gui_heading(const char *text); /* of a group of rows: small, in capitals as given */
void wr_gui_label(const char *text);   /* left part of a row; the field follows on the same line */
double wr_gui_text_width(WrFont font, const char *text);
double wr_gui_line_height(WrFont font);
void wr_gui_tip(const char *text); /* of the widget before; shown when the pointer rests on it */

/* ---- widgets ---- */
/* What happened to a value in this frame. */
typedef enum WrEdit {
    WR_EDIT_NONE,
    WR_EDIT_LIVE, /* being dragged: *value is what it would become */
    WR_EDIT_DONE  /* the edit is finished */
} WrEdit;

typedef struct WrNumber {
    double low, high;           /* soft range: what a drag reaches, low < high */
    double hard_low, hard_high; /* what typing may reach; both 0: the soft range */
    double reset;               /* value after a double click */
    int decimals;               /* digits after the point; -1: up to four significant digits */
    const char *unit;           /* "px", "deg"; may be NULL */
    bool logarithmic;           /* drag moves by equal ratios; low > 0 */
    const char *tip;            /* may be NULL */
} WrNumber;

/* A slider that can be typed into: drag moves it, a click types, a double click resets. width <= 0:
   what is left of the row. */
WrEdit wr_gui_number(const char *id, double width, const WrNumber *spec, double *value);
bool wr_gui_choice(const char *id, double width, const char *const *items, int count, int *index);
/* Buttons in a row, one of them chosen; colours[i] (may be NULL) shows while i is the chosen one. */
bool wr_gui_segments(const char *id, const char *const *items, const WrColour *colours, int count,
                     int *index);
/* Tabs across the area, each row 32 units high; in a smaller face where they would touch, then in two rows. */
bool wr_gui_tabs(const char *id, const char *const *items, int count, int *index);
/* How many rows that takes, 1 or 2. */
int wr_gui_tab_rows(const char *const *items, int count, double width);
WrEdit wr_gui_colour(const char *id, double width, double linear_rgb[3]);
bool wr_gui_check(const char *label, bool *value);
/* The next button or chip keeps this id while its label changes with what it does, so that the keyboard's ring stays on it
   and a quick second click counts. Not where the new label asks to confirm. */
void wr_gui_next_id(const char *id);
bool wr_gui_button(const char *label, bool primary);
/* A flat button of one icon, `units` wide and high. */
bool wr_gui_icon_button(const char *id, const char *icon, double units, bool selected);
/* The same, smaller, without a ground. */
bool wr_gui_glyph(const char *id, const char *icon, double units, WrColour colour);
/* A clickable word with an icon in front (may be NULL), on a dark chip. */
bool wr_gui_chip(const char *icon, const char *label);
/* A button that looks like a field: a word, and its keys at the right. */
bool wr_gui_find_button(const char *label, const char *keys, double width);
/* A field for one line. focus: give it the keyboard now. True when Return was pressed. */
bool wr_gui_text_field(const char *id, double width, char *text, size_t size, bool focus);
/* A field for several lines, as many of them tall; focus as above. True when the text changed. */
bool wr_gui_text_area(const char *id, int lines, char *text, size_t size, bool focus);
/* A row of a list: 0 nothing, 1 clicked, 2 double-clicked. */
int wr_gui_list_row(const char *icon, const char *label, bool selected);
void wr_gui_list_begin(const char *id, double height);
void wr_gui_list_end(void);
/* A field for one line with a hint while it is empty. True when the text changed. */
bool wr_gui_hint_field(const char *id, const char *hint, double width, char *text, size_t size);
/* A heading that folds away what it heads: true while that is shown. */
bool wr_gui_fold(const char *label, bool open_at_first);
/* A square picture to choose, `side` pixels: 0 nothing, 1 clicked, 2 pressed with the right button.
 * marked: with a small star. texture may be NULL. */
int wr_gui_tile(const char *id, SDL_Texture *texture, double side, bool selected, bool marked);
bool wr_gui_will_see(double side); /* some of a tile that came next would not be scrolled away */
/* In a bar: what comes next, so many pixels high, has its middle at that of the fields; and after it. */
void wr_gui_centre(double side);
void wr_gui_centre_end(double side);
void wr_gui_mark(WrColour colour); /* a small upright bar of that colour, as tall as a field */
void wr_gui_width_at_least(double units); /* of the popup that is open */
/* The text field before lost the keyboard in this frame, by Return, Escape or a click elsewhere. */
bool wr_gui_field_left(void);
/* A bar that fills; fraction 0..1, below 0: nobody knows how far it is. width <= 0: what is left of the row. */
void wr_gui_progress(double width, double fraction);
/* A dark square with its four sides coloured (left, right, top, bottom); for a tip. */
void wr_gui_square(const char *id, double units, const WrColour sides[4]);

/* ---- rows that hold widgets: between begin and end, wr_gui_row_at says where the next one goes ---- */
typedef struct WrRow {
    double top, height;    /* pixels of the window */
    double pointer_y;      /* pixels of the window */
    bool clicked, doubled; /* let go over the row without dragging, for the second time at once */
    bool menu;             /* pressed with the right button */
    bool dragging;         /* held and moved */
    bool dropped;          /* let go after dragging */
} WrRow;
/* Across the whole area. */
WrRow wr_gui_row_begin(int id, double height_units, bool selected);
/* x: pixels from the row's left edge. tall: height of what comes, pixels; 0: a line of text. */
void wr_gui_row_at(double x, double tall);
void wr_gui_row_see(void);     /* right after begin: its list scrolls until it is seen */
double wr_gui_row_width(void); /* pixels */
void wr_gui_row_end(void);
/* A line across the area at y pixels of the window: where what is dragged will go. */
void wr_gui_drop_line(double y);
/* Text cut off with dots where it is wider than `width` pixels. */
void wr_gui_text_cut(WrFont font, WrColour colour, const char *text, double width);
/* In as many lines as it takes, `width` pixels wide. */
void wr_gui_text_within(WrFont font, WrColour colour, const char *text, double width);
/* A picture of w x h pixels, with a thin edge. */
void wr_gui_image(SDL_Texture *texture, double w, double h);
/* The same as a button; chosen: with a frame around it. */
bool wr_gui_image_button(const char *id, SDL_Texture *texture, double w, double h, bool chosen);
/* w x h pixels of a picture that says by its opacity where that colour goes; NULL only takes its place. */
void wr_gui_ink(SDL_Texture *texture, double w, double h, WrColour colour);
/* Looks like a choice, `width` pixels wide, its label cut off where it is too long; what opens is the caller's. */
bool wr_gui_list_button(const char *id, const char *label, double width);

/* ---- menus, popups, dialogs: begin returns true while open, and only then end follows ---- */
/* tight: there is little room. Returns its height in pixels. */
double wr_gui_menu_bar_begin(bool tight);
void wr_gui_menu_bar_end(void);
bool wr_gui_menu_begin(const char *label);
void wr_gui_menu_end(void);
bool wr_gui_menu_item(const char *label, const char *keys, bool checked, bool enabled);
void wr_gui_menu_separator(void);
void wr_gui_popup_open(const char *id);
bool wr_gui_popup_begin(const char *id);
void wr_gui_popup_end(void);
void wr_gui_popup_close(void); /* the one that is being drawn */
/* A dialog in the middle of the window, which takes all input. `open` true shows it. Escape or a
   click beside it does not close it: the caller decides. */
bool wr_gui_dialog_begin(const char *title, double width_units);
/* The same at a place of its own, at least that tall, nothing dimmed: the views show what it does. */
bool wr_gui_dialog_begin_at(const char *title, SDL_Rect place);
void wr_gui_dialog_end(void);
bool wr_gui_escape_pressed(void); /* in this frame */
bool wr_gui_return_pressed(void); /* in this frame, and no text field took it */
bool wr_gui_letter_pressed(SDL_Scancode key);
bool wr_gui_key_pressed(SDL_Scancode key); /* in this frame, or repeated; text field or not */

/* ---- fields to draw on and to point at ---- */
typedef struct WrPad {
    double x, y, w, h;           /* pixels of the window */
    double pointer_x, pointer_y; /* the same; where it left the window while it is outside */
    bool hovered;                /* the pointer is on it */
    bool pressed, held,
        released; /* the left button, on it: went down, is down, went up at the pointer */
} WrPad;
/* w x h pixels; w <= 0: what is left of the row. Until pad_end the drawing below goes to it, clipped. */
WrPad wr_gui_pad_begin(const char *id, double w, double h);
void wr_gui_pad_end(void);
/* A disc of that radius, pixels, in the middle of a line so many pixels high. */
void wr_gui_swatch(WrColour colour, double radius, double tall);
/* Widgets that stand together beside what was before: after wr_gui_same_line. */
void wr_gui_group_begin(void);
void wr_gui_group_end(void);

/* ---- drawing on the views, under the panels ---- */
void wr_gui_draw_clip(SDL_Rect rect);
void wr_gui_draw_unclip(void);
void wr_gui_draw_line(double x0, double y0, double x1, double y1, WrColour colour, double width);
void wr_gui_draw_rect(double x, double y, double w, double h, WrColour colour, double width);
void wr_gui_draw_fill(double x, double y, double w, double h, WrColour colour, double rounding);
/* Filled; four corners, in their order round it. */
void wr_gui_draw_quad(const double x[4], const double y[4], WrColour colour);
void wr_gui_draw_circle(double x, double y, double radius, WrColour colour, double width);
void wr_gui_draw_disc(double x, double y, double radius, WrColour colour);
/* Part of a circle, clockwise from the top; turns 0..1. */
void wr_gui_draw_arc(double x, double y, double radius, double turns, WrColour colour,
                     double width);
void wr_gui_draw_text(double x, double y, WrFont font, WrColour colour, const char *text);

#ifdef __cplusplus
}
#endif
