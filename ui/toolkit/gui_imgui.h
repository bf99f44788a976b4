/* gui_imgui.h - shared state and helpers of the gui_imgui*.cpp files. Private to them. */
#pragma once
#include "ui/toolkit/focus.h"
#include "ui/toolkit/folds.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_rows.h"
#include "ui/toolkit/gui_imgui_versions.hpp"
#include "ui/toolkit/words.h"

extern "C" {
#include "base/error.h"
}

#include <imgui.h>
#include <stdbool.h>
#include <stdint.h>

struct ImGuiWindow;

#define WR_GUI_KEYS 512 /* keyboard keys, by SDL_Scancode */

#define WR_GUI_STOPS 2000
#define WR_GUI_WAITING 16 /* queued keys for the focus */
#define WR_GUI_LEVELS 8   /* nesting depth of menus */

/* State of the keyboard focus. */
struct WrFocus {
    /* Reachable widgets of the last frame, and of the present one; owned, WR_GUI_STOPS each. */
    WrKeyStop *stops, *coming;
    int count, coming_count;
    ImGuiID at; /* 0: none */
    int index;  /* index of its stop in the last frame that had it */
    bool shown; /* the ring is visible; the keys belong to it */
    bool took;  /* used the newest key press */
    bool moved; /* scroll until the ring is visible */
    bool first; /* the first stop of the opening list gets the ring */
    SDL_Keysym waiting[WR_GUI_WAITING];
    int waiting_count;
    SDL_Keysym key;     /* key for the stop at `at` in this frame; no scancode: none */
    bool pressed;       /* pressed in this frame as by the pointer */
    bool stepped_rows;  /* the key of this frame moved the ring from row to row */
    bool arrow_let_go;  /* an arrow key was released */
    ImGuiID stepped;    /* number field changed by arrow keys: drag_value */
    bool step_ends;     /* its change ends in this frame */
    float pad_x, pad_y; /* pointer of the keys on a pad, 0..1 */
    bool pad_held;      /* its button is held */
    ImGuiID pad_down;   /* pad on which it is held */
    bool pad_cross;     /* visible on the pad being drawn, at pad_at */
    ImVec2 pad_at;
    bool stop_typing;               /* end the editing of the text */
    int close_to;                   /* close popups deeper than this; -1: none */
    int levels;                     /* number of open popups in the last frame */
    bool beside;                    /* the popups of the next frame replace them */
    ImGuiID popups[WR_GUI_LEVELS];  /* identifiers of the popups */
    ImGuiID openers[WR_GUI_LEVELS]; /* focus at the opening of each popup */
    bool before[WR_GUI_LEVELS];     /* visibility of the ring at the opening */
    ImGuiID home;                   /* focus before the menus were entered */
    bool in_menus;                  /* entered by wr_gui_focus_menus */
    /* seconds since the start when Alt was pressed, without other keys since; 0: not pressed */
    double alt_at;
};

/* A key press or release, or letters typed. */
struct WrTyped {
    SDL_Keysym key;
    bool down;
    char letters[SDL_TEXTINPUTEVENT_TEXT_SIZE]; /* UTF-8; "" for a key */
};

#define WR_GUI_SCOPE 48 /* bytes of a name of an area */
#define WR_GUI_PIN 256  /* bytes of a name of a row */
/* Highlight of a row (gui_rows.h). */
struct WrLight {
    char section[128], label[256]; /* label "": none */
    Uint64 since;                  /* SDL_GetTicks64 when it was drawn first; 0: not yet */
    int waited;                    /* frames since its request */
    int scrolls;                   /* frames in which the area still scrolls to it */
    int lit_in;                    /* frame in which it was drawn last */
    bool inside;                   /* the rows being drawn are in its section */
    bool heading;                  /* the section's heading is framed instead */
    float scrolled;                /* how far the area was scrolled, pixels */
    float place[4];                /* x, y, width, height, pixels of the window */
};

#define WR_GUI_SHOWN 64 /* recorded windows, menus and dialogs of a frame */

/* A window of the displayed frame. */
struct WrShownWindow {
    ImGuiID id;
    float x0, y0, x1, y1; /* pixels of the window */
};

struct WrGui {
    SDL_Renderer *renderer; /* borrowed */
    ImGuiContext *context;  /* owned */
    SDL_Texture *atlas;     /* owned */
    WrRetainedFrame *kept;  /* owned */
    /* tip of disabled widgets, between wr_gui_hold and _end; NULL: enabled */
    const char *grey_why;
    ImFont *fonts[WR_FONT_COUNT];
    double scale;
    char **font_files;      /* WR_GUI_FONT_FILES; borrowed */
    bool no_icons, no_text; /* their fonts are missing */
    bool held[3];           /* button states from events */
    bool pressed[3];        /* pressed since the last frame, so that no press is missed */
    /* Pressed although held in that frame: a frame with the button released must come between. */
    bool again[3];
    ImVec2 let_go_at;                              /* position of the last release */
    bool let_go;                                   /* the last frame had the pointer there */
    bool down[WR_GUI_KEYS], was_down[WR_GUI_KEYS]; /* keys passed to ImGui; in the last frame */
    bool released_late[WR_GUI_KEYS]; /* keys pressed and released between two frames */
    bool pressed_now[WR_GUI_KEYS];
    int held_late; /* KMOD_ bits held during a key press since the last frame */
    /* Queued keys and letters in their order; owned. */
    WrTyped *typed_on;
    int typed_count, typed_room; /* number, capacity */
    int typed_held;              /* KMOD_ bits at the last one passed to a frame */
    char clipboard[4096];
    bool close_popups; /* Escape was pressed over a menu */
    ImGuiID selecting; /* text area that gets the focus: its text will be selected */
    bool fits;         /* an auto-sized window changed since the previous frame */
    double fitted;     /* fitted_sizes */
    ImVec2 pointer;    /* its last position, inside the window or not */
    bool tip_waits;    /* the pointer rests where a tip will be shown */
    ImVec2 tip_at;     /* corner of the item below the pointer, */
    double tip_since;  /* time of its arrival, */
    int tip_frame;     /* last frame in which it was there */
    int popups;        /* popups open at the start of the frame */
    bool list_open;    /* one of them is a list or a menu, which gets the keys of this frame */
    bool keys_dropped; /* keys were released for the widgets after the start of their frame */
    ImGuiID chooser;   /* the open list, and its row for Return */
    int chooser_row;
    /* number fields */
    ImGuiID typing, dragging;
    bool typing_focus, moved;
    int typing_frame; /* when the field that is typed into was last drawn */
    double drag_value, drag_from;
    double drag_start; /* value of the dragged field at the press */
    float drag_x;
    char typed[64];
    /* the open row in pixels of the window; the dragged row */
    float row_left, row_right, row_top, row_height;
    int clicks; /* of the last left press, counted by the time of its event, since frames may be late; 2: a double click */
    ImGuiID row_drag, row_double;      /* row_double: pressed for the second time */
    bool drag_scrolls;                 /* its area scrolls in this frame */
    float scroll_rest;                 /* part of a pixel that it has not scrolled yet */
    ImDrawList *pad;                   /* target of drawing; NULL: the views */
    bool as_it_is;                     /* texts are user-defined and not translated */
    const char *next_id;               /* of wr_gui_next_id; NULL: none */
    WrShownWindow shown[WR_GUI_SHOWN]; /* windows of the displayed frame, lowest first */
    int shown_count;
    ImGuiID shown_top;             /* the topmost open menu or dialog; 0: none */
    char **folds;                  /* borrowed, or NULL */
    char scope[WR_GUI_SCOPE];      /* name of the area being drawn */
    char fold_scope[WR_GUI_SCOPE]; /* area in which all folds will be opened or closed, */
    int fold_frame;                /* in this frame, */
    bool fold_open;                /* to this state */
    char section[96];              /* label of the last fold of the area */
    /* pinned rows (gui_imgui_pins.cpp); borrowed, or NULL */
    char **pins;
    int pins_most;
    bool pinnable, pinning, pin_skips;
    char pin_area[WR_GUI_SCOPE];
    float pin_low;              /* a widget below this starts another row */
    ImVec2 pin_cursor, pin_end; /* ImGui's layout before rows were skipped */
    char pin_asked[WR_GUI_PIN]; /* the row with the open menu */
    bool pin_opens;
    int tab_torn, tab_menu; /* of the previous tabs; -1: none */
    ImGuiID float_id;       /* the floating panel being drawn, */
    SDL_Rect float_rect;
    bool floating;      /* areas are parts of a floating panel */
    ImGuiID float_held; /* the floating panel that is dragged or resized, */
    bool float_resized;
    ImVec2 float_from; /* the pointer relative to the panel's corner at the press */
    WrFocus focus;
    WrLight light;
    struct {
        WrRowReport *report; /* NULL: rows are not being listed */
        void *ctx;
    } rows;
};

/* The WrGui of the present frame. */
WrGui *wr_gui_current(void);
/* gui_imgui_keys.cpp. Set-up before the first frame; a key; typed letters; release of all keys; just before a frame;
   just after its start: true if queued input is left for the next frame. */
void wr_gui_keys_begin();
void wr_gui_keys_event(WrGui *gui, const SDL_KeyboardEvent *key);
void wr_gui_keys_letters(WrGui *gui, const char *utf8);
void wr_gui_keys_release(WrGui *gui);
void wr_gui_keys_frame(WrGui *gui);
bool wr_gui_keys_seen(WrGui *gui);
/* Keys by position: pressed since the last frame; the second one includes key repeats. */
bool wr_gui_went_down(SDL_Scancode key);
bool wr_gui_key_repeats(SDL_Scancode key);
bool wr_gui_return_for_list(); /* wr_gui_return_pressed for the open list */
/* gui_imgui_focus.cpp. An event, true if the key belongs to the focus alone; before and after the start of a frame,
   and before its end. */
bool wr_gui_focus_event(WrGui *gui, const SDL_Event *event);
void wr_gui_focus_before(WrGui *gui);
void wr_gui_focus_begun(WrGui *gui);
void wr_gui_focus_end(WrGui *gui);
/* Register the last item, or one at a position, as reachable by keys. */
void wr_gui_stop(WrKeyStopKind kind, bool chosen);
void wr_gui_stop_at(WrKeyStopKind kind, ImGuiID id, bool chosen, ImVec2 low, ImVec2 high);
/* Register an entry of `window` whose menu is open, while that is the current window. */
void wr_gui_stop_open(ImGuiWindow *window, ImGuiID id);
/* End of a window without reachable items: if it scrolls, keys scroll it. */
void wr_gui_stop_scrolled();
bool wr_gui_focused(ImGuiID id);                     /* it has the ring */
bool wr_gui_focus_pressed(ImGuiID id);               /* by Space or Enter, in this frame */
bool wr_gui_focus_key(ImGuiID id, SDL_Scancode key); /* it gets that key in this frame */
bool wr_gui_focus_menu(ImGuiID id);                  /* the key for a context menu */
/* 1 up or right, -1 down or left; both: all four keys */
int wr_gui_focus_arrows(ImGuiID id, bool both);
/* gui_imgui_rows.cpp. A label before its row is drawn; the last item, a button; a heading before it is drawn: true if the section
   must be open; alternatives; a tip; before a frame. */
void wr_gui_row_label(const char *label);
void wr_gui_row_button(const char *label);
bool wr_gui_row_section(const char *label);
void wr_gui_row_choices(const char *const *items, int count);
void wr_gui_row_tip(const char *text);
void wr_gui_row_menu(const char *label); /* NULL: its end */
void wr_gui_light_frame(WrGui *gui);
/* gui_imgui_words.cpp. A text translated, up to ##; and a label for ImGui: translated text with the English one as
   identifier. */
const char *wr_gui_said(const char *text);
bool wr_gui_popup_stand_in(const char *name);
const char *wr_gui_labelled(const char *label, char (&buffer)[320]);
/* Report the width of a text and its available room to tests; of the last item's text, if its window is visible. */
void wr_gui_fits(const char *text, float width, float room);
void wr_gui_fits_window(const char *text);
/* Available width in the row; if less than `width`, a new row is started, except in bars. */
float wr_gui_row_room(float width);
/* Draw an icon that no font has (gui_imgui_fonts.cpp); true if there is one. */
bool wr_gui_draw_icon(ImDrawList *list, const char *icon, ImVec2 at, float side, ImU32 ink);
/* The icon, or a word without the icon font. */
const char *wr_gui_icon(const char *icon);
/* Rasterise the fonts at the present scale and create their texture. */
bool wr_gui_build_fonts(WrGui *gui, WrError *err);
ImU32 wr_gui_colour_u32(WrColour colour); /* from 0xAARRGGBB to ImGui's order */
ImVec4 wr_gui_colour_vec4(WrColour colour);
/* A border of whole pixels without its corners: SDL's software renderer draws thin antialiased lines unevenly. */
void wr_gui_edge(ImDrawList *list, ImVec2 low, ImVec2 high);
/* The name of an area without "##" and final digits. */
void wr_gui_area_name(const char *scope, char (&name)[WR_GUI_SCOPE]);
/* gui_imgui_pins.cpp: a row starts, with its widgets in the line below its label if two_lines; a widget that may start
   another row; the end of an area. */
void wr_gui_pin_row(const char *label, bool two_lines);
void wr_gui_pin_step();
void wr_gui_pin_menu();
/* Tip of the last item, whose identifier for the ring is `id`. */
void wr_gui_tip_of(ImGuiID id, const char *text);

bool wr_gui_is_list(const ImGuiWindow *window); /* a list within a part */

/* No exception may reach C. Appended to a function whose body is a try block. */
#define WR_CAUGHT(value)                                                                           \
    catch (...)                                                                                    \
    {                                                                                              \
        return value;                                                                              \
    }
