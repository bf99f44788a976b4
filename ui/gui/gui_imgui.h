/* gui_imgui.h - what the gui_imgui*.cpp files share; nobody else includes it. */
#pragma once
#include "ui/gui/gui.h"
#include "ui/gui/words.h"

extern "C" {
#include "base/error.h"
}

#include <imgui.h>
#include <stdbool.h>
#include <stdint.h>

#define WR_GUI_KEYS 512 /* of the keyboard, by SDL_Scancode */
#define WR_GUI_TYPED 64

/* A key that went down or up, or letters that came of keys. */
struct WrTyped {
    SDL_Keysym key;
    bool down;
    char letters[SDL_TEXTINPUTEVENT_TEXT_SIZE]; /* UTF-8; "" for a key */
};

struct WrGui {
    SDL_Renderer *renderer; /* borrowed */
    ImGuiContext *context;  /* owned */
    ImGuiContext *aside;    /* owned; NULL until it is needed */
    SDL_Texture *atlas;     /* owned */
    ImFont *fonts[WR_FONT_COUNT];
    double scale;
    bool no_icons, no_text;          /* their fonts were not found */
    bool held[3];                    /* buttons as the events say */
    bool pressed[3];                 /* that went down since the last frame: none is ever missed */
    bool released_late[WR_GUI_KEYS]; /* keys that went down and up between two frames */
    bool pressed_now[WR_GUI_KEYS];
    int held_late; /* KMOD_ bits held while a key went down since the last frame */
    WrTyped typed_on
        [WR_GUI_TYPED]; /* keys and letters that no frame has had, in the order in which they came */
    int typed_count;
    int typed_held; /* KMOD_ bits held at the last of those that frames had */
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
    ImDrawList *pad; /* that drawing goes to; NULL: to the views */
    bool as_it_is;   /* texts are the user's own and are not looked up */
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
/* The icon, or the word for it where there is no font of icons. */
const char *wr_gui_icon(const char *icon);
/* Draw the faces at the present scale and hand them to the renderer. */
bool wr_gui_build_fonts(WrGui *gui, WrError *err);
ImU32 wr_gui_colour_of(WrColour colour); /* 0xAARRGGBB as ImGui packs it */
ImVec4 wr_gui_vec_of(WrColour colour);
/* A thin edge of whole pixels, its corners left out: SDL's software renderer draws smooth thin outlines
   unevenly. */
void wr_gui_edge(ImDrawList *list, ImVec2 low, ImVec2 high);
/* A tip that does not cover the fields around the last item, which is one of a column. */
void wr_gui_tip_of_field(const char *text);

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
