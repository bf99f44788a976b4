/* gui_imgui.h - what the gui_imgui*.cpp files share; nobody else includes it. */
#pragma once
#include "ui/toolkit/focus.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/words.h"

extern "C" {
#include "base/error.h"
}

#include <imgui.h>
#include <stdbool.h>
#include <stdint.h>

struct ImGuiWindow;

#define WR_GUI_KEYS 512 /* of the keyboard, by SDL_Scancode */

#define WR_GUI_STOPS 2000
#define WR_GUI_WAITING 16 /* keys for the focus that no frame has had */
#define WR_GUI_LEVELS 8   /* menus within menus */

/* Where the keys are. */
struct WrFocus {
    /* Of the last frame, and of the one that is being made; owned, WR_GUI_STOPS each. */
    WrKeyStop *stops, *coming;
    int count, coming_count;
    ImGuiID at; /* 0: none */
    int index;  /* of its stop, in the last frame that had it */
    bool shown; /* the ring is; the keys are for it */
    bool took;  /* the newest key that went down */
    bool moved; /* it shall be scrolled to where it is seen */
    bool first; /* the list that comes: its first stop gets it */
    SDL_Keysym waiting[WR_GUI_WAITING];
    int waiting_count;
    SDL_Keysym key;     /* that the stop at `at` gets in this frame; no scancode: none */
    bool pressed;       /* it is pressed in this frame as by the pointer */
    bool arrow_let_go;  /* an arrow was */
    ImGuiID stepped;    /* a number that arrows move: drag_value */
    bool step_ends;     /* it is done with in this frame */
    float pad_x, pad_y; /* the keys' pointer on a pad, 0..1 */
    bool pad_held;      /* and its button */
    ImGuiID pad_down;   /* the pad that it is held on */
    bool pad_cross;     /* it is seen on the pad that is being drawn, at pad_at */
    ImVec2 pad_at;
    bool stop_typing; /* the text that is being typed is left */
    int close_to;     /* popups deeper than this close; -1: none */
    int levels;       /* popups that were open in the last frame */
    bool beside;      /* and what is open in the next frame was opened in the place of them */
    ImGuiID popups[WR_GUI_LEVELS];  /* their names */
    ImGuiID openers[WR_GUI_LEVELS]; /* where the focus was when each of them came */
    bool before[WR_GUI_LEVELS];     /* and whether it was shown */
    ImGuiID home;                   /* where it was before it came to the menus */
    bool in_menus;                  /* it came there by wr_gui_focus_menus */
    double alt_at; /* seconds since the start when Alt went down, and nothing since; 0: it is up */
};

/* A key that went down or up, or letters that came of keys. */
struct WrTyped {
    SDL_Keysym key;
    bool down;
    char letters[SDL_TEXTINPUTEVENT_TEXT_SIZE]; /* UTF-8; "" for a key */
};

#define WR_GUI_SHOWN 64 /* windows, menus and dialogs of a picture */

/* One of them, as it is on the screen. */
struct WrShownWindow {
    ImGuiID id;
    float x0, y0, x1, y1; /* pixels of the window */
};

struct WrGui {
    SDL_Renderer *renderer; /* borrowed */
    ImGuiContext *context;  /* owned */
    SDL_Texture *atlas;     /* owned */
    WrRetainedFrame *kept;  /* owned */
    const char *grey_why;   /* of what comes, between wr_gui_hold and _end; NULL: it is not grey */
    ImFont *fonts[WR_FONT_COUNT];
    double scale;
    bool no_icons, no_text; /* their fonts were not found */
    bool held[3];           /* buttons as the events say */
    bool pressed[3];        /* that went down since the last frame: none is ever missed */
    /* And were down in that one: a frame in which they are up comes between. */
    bool again[3];
    ImVec2 let_go_at;                /* where a button went up last */
    bool let_go;                     /* the last frame had the pointer there */
    bool released_late[WR_GUI_KEYS]; /* keys that went down and up between two frames */
    bool pressed_now[WR_GUI_KEYS];
    int held_late; /* KMOD_ bits held while a key went down since the last frame */
    /* Keys and letters that no frame has had, in the order in which they came; owned. */
    WrTyped *typed_on;
    int typed_count, typed_room; /* how many there are, and fit */
    int typed_held;              /* KMOD_ bits held at the last of those that frames had */
    char clipboard[4096];
    bool close_popups; /* Escape was pressed over a menu */
    ImGuiID selecting; /* a text area that gets the keyboard: its text will be selected */
    bool fits;         /* a window that fits its content was not as in the frame before */
    double fitted;     /* fitted_sizes */
    ImVec2 pointer;    /* where it was last, the window left or not */
    bool tip_waits;    /* the pointer rests where a tip will be shown */
    ImVec2 tip_at;     /* the corner of the item that it rests on, */
    double tip_since;  /* since then, */
    int tip_frame;     /* as of this frame */
    int popups;        /* open when the frame began */
    bool list_open;    /* a list or a menu was among them: the keys of this frame are for it */
    bool keys_dropped; /* keys were let go for the widgets after their frame had begun */
    ImGuiID chooser;   /* the list that is open, and its row that Return takes */
    int chooser_row;
    /* number fields */
    ImGuiID typing, armed, dragging;
    bool typing_focus, moved;
    double armed_since, drag_value, drag_from;
    float drag_x;
    char typed[64];
    /* the row that is open, in pixels of the window; and the one that is dragged */
    float row_left, row_right, row_top, row_height;
    ImGuiID row_drag;
    ImDrawList *pad;                   /* that drawing goes to; NULL: to the views */
    bool as_it_is;                     /* texts are the user's own and are not looked up */
    const char *next_id;               /* of wr_gui_next_id; NULL: none */
    WrShownWindow shown[WR_GUI_SHOWN]; /* of the picture on the screen, the lowest first */
    int shown_count;
    ImGuiID shown_top; /* the newest menu or dialog that is open there; 0: none */
    WrFocus focus;
};

/* The one whose frame is open. */
WrGui *wr_gui_current(void);
/* gui_imgui_keys.cpp. Before the first frame; a key; letters that were typed; all are let go; just before a frame; just after it
   has begun: true if there is something that the widgets have not seen yet. */
void wr_gui_keys_begin();
void wr_gui_keys_event(WrGui *gui, const SDL_KeyboardEvent *key);
void wr_gui_keys_letters(WrGui *gui, const char *utf8);
void wr_gui_keys_release(WrGui *gui);
void wr_gui_keys_frame(WrGui *gui);
bool wr_gui_keys_seen(WrGui *gui);
/* Keys, by their place: went down since the last frame; the same, or it is held and repeats. */
bool wr_gui_went_down(SDL_Scancode key);
bool wr_gui_key_repeats(SDL_Scancode key);
bool wr_gui_return_for_list(); /* as wr_gui_return_pressed, for the list that is open */
/* gui_imgui_focus.cpp. An event, true if it is a key for the focus alone; before and after a frame has begun, and before it
   ends. */
bool wr_gui_focus_event(WrGui *gui, const SDL_Event *event);
void wr_gui_focus_before(WrGui *gui);
void wr_gui_focus_begun(WrGui *gui);
void wr_gui_focus_end(WrGui *gui);
/* The last item, or one at a place, can be reached by keys. */
void wr_gui_stop(WrKeyStopKind kind, bool chosen);
void wr_gui_stop_at(WrKeyStopKind kind, ImGuiID id, bool chosen, ImVec2 low, ImVec2 high);
/* An entry of `window` whose menu is open, and current. */
void wr_gui_stop_open(ImGuiWindow *window, ImGuiID id);
/* The window that ends has nothing to press: if it scrolls, keys scroll it. */
void wr_gui_stop_scrolled();
bool wr_gui_focused(ImGuiID id);                     /* it has the ring */
bool wr_gui_focus_pressed(ImGuiID id);               /* by Space or Enter, in this frame */
bool wr_gui_focus_key(ImGuiID id, SDL_Scancode key); /* it gets that key in this frame */
bool wr_gui_focus_menu(ImGuiID id);                  /* as by the right button */
int wr_gui_focus_arrows(ImGuiID id, bool both); /* 1 up or right, -1 down or left; both: all four */
/* gui_imgui_words.cpp. A text in the user's language, without what follows ##; and for the library, what is seen in that
   language and an identity by the English one. */
const char *wr_gui_said(const char *text);
bool wr_gui_stands_in(const char *name);
const char *wr_gui_labelled(const char *label, char (&buffer)[320]);
/* A text so wide stands where there is that much room; the last item's text so wide, where its window is seen. */
void wr_gui_fits(const char *text, float width, float room);
void wr_gui_fits_window(const char *text);
/* Room in the row for what is so wide; where that is too little a new row is begun, but in bars. */
float wr_gui_row_room(float width);
/* Of those that no font has (gui_imgui_icons.cpp): draws it and returns true. */
bool wr_gui_draw_icon(ImDrawList *list, const char *icon, ImVec2 at, float side, ImU32 ink);
/* The icon, or the word for it where there is no font of icons. */
const char *wr_gui_icon(const char *icon);
/* Draw the faces at the present scale and hand them to the renderer. */
bool wr_gui_build_fonts(WrGui *gui, WrError *err);
ImU32 wr_gui_colour_of(WrColour colour); /* 0xAARRGGBB as ImGui packs it */
ImVec4 wr_gui_vec_of(WrColour colour);
/* A thin edge of whole pixels, its corners left out: SDL's software renderer draws smooth thin outlines
   unevenly. */
void wr_gui_edge(ImDrawList *list, ImVec2 low, ImVec2 high);
/* The tip of the last item, which has that name for the ring. */
void wr_gui_tip_of(ImGuiID id, const char *text);

/* What other versions of the library call by other names; keys are in gui_imgui_keys.cpp, faces in
   gui_imgui_fonts.cpp. */
inline float wr_gui_size_of(const ImFont *font)
{
#if IMGUI_VERSION_NUM >= 19200
    return font->LegacySize;
#else
    return font->FontSize;
#endif
}

/* A pointer in some versions, a number in others: these casts fit both. */
inline ImTextureID wr_gui_texture_id(SDL_Texture *texture)
{
    return (ImTextureID)(intptr_t)texture;
}

inline SDL_Texture *wr_gui_texture_of(ImTextureID id)
{
    return (SDL_Texture *)(intptr_t)id;
}

/* Nothing that is thrown may reach C. Written after a function's body that is a try block. */
#define WR_CAUGHT(value)                                                                           \
    catch (...)                                                                                    \
    {                                                                                              \
        return value;                                                                              \
    }
