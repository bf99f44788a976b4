/* Keys on their way to the widget library. From 1.87 on it has a queue of key events and names of its own
   for keys; before, an array of them by the platform's numbers. This file alone knows which. */
#include "ui/gui/gui_imgui.h"

#include <string.h>

static const struct {
    ImGuiKey imgui;
    SDL_Scancode sdl;
} keys[] = { { ImGuiKey_Tab, SDL_SCANCODE_TAB },
             { ImGuiKey_LeftArrow, SDL_SCANCODE_LEFT },
             { ImGuiKey_RightArrow, SDL_SCANCODE_RIGHT },
             { ImGuiKey_UpArrow, SDL_SCANCODE_UP },
             { ImGuiKey_DownArrow, SDL_SCANCODE_DOWN },
             { ImGuiKey_PageUp, SDL_SCANCODE_PAGEUP },
             { ImGuiKey_PageDown, SDL_SCANCODE_PAGEDOWN },
             { ImGuiKey_Home, SDL_SCANCODE_HOME },
             { ImGuiKey_End, SDL_SCANCODE_END },
             { ImGuiKey_Insert, SDL_SCANCODE_INSERT },
             { ImGuiKey_Delete, SDL_SCANCODE_DELETE },
             { ImGuiKey_Backspace, SDL_SCANCODE_BACKSPACE },
             { ImGuiKey_Space, SDL_SCANCODE_SPACE },
             { ImGuiKey_Enter, SDL_SCANCODE_RETURN },
             { ImGuiKey_Escape, SDL_SCANCODE_ESCAPE },
#if IMGUI_VERSION_NUM >= 18700
             { ImGuiKey_KeypadEnter, SDL_SCANCODE_KP_ENTER },
             { ImGuiKey_D, SDL_SCANCODE_D },
             { ImGuiKey_R, SDL_SCANCODE_R },
             { ImGuiKey_S, SDL_SCANCODE_S },
#else
             { ImGuiKey_KeyPadEnter, SDL_SCANCODE_KP_ENTER },
#endif
             { ImGuiKey_A, SDL_SCANCODE_A },
             { ImGuiKey_C, SDL_SCANCODE_C },
             { ImGuiKey_V, SDL_SCANCODE_V },
             { ImGuiKey_X, SDL_SCANCODE_X },
             { ImGuiKey_Y, SDL_SCANCODE_Y },
             { ImGuiKey_Z, SDL_SCANCODE_Z } };

static bool is_key(int code)
{
    return code >= 0 && code < WR_GUI_KEYS;
}

#if IMGUI_VERSION_NUM >= 18700

/* The library spreads what comes between two frames over as many frames as it takes, so that no key is
   missed; held ones count with the key that goes down while they are. */

#if IMGUI_VERSION_NUM >= 18900
#define MOD(name) ImGuiMod_##name
#else
#define MOD(name) ImGuiKey_Mod##name
#endif

static ImGuiKey key_of(int code)
{
    for (const auto &pair : keys)
        if (pair.sdl == code) return pair.imgui;
    return ImGuiKey_None;
}

static void send_held(int mod)
{
    ImGuiIO &io = ImGui::GetIO();
    io.AddKeyEvent(MOD(Ctrl), (mod & KMOD_CTRL) != 0);
    io.AddKeyEvent(MOD(Shift), (mod & KMOD_SHIFT) != 0);
    io.AddKeyEvent(MOD(Alt), (mod & KMOD_ALT) != 0);
}

void wr_gui_keys_begin()
{
}

void wr_gui_keys_event(WrGui *gui, const SDL_KeyboardEvent *key)
{
    ImGuiKey known = key_of(key->keysym.scancode);
    bool down = key->type == SDL_KEYDOWN;
    if (down && key->keysym.scancode == SDL_SCANCODE_ESCAPE) gui->close_popups = true;
    send_held(key->keysym.mod);
    if (known != ImGuiKey_None) ImGui::GetIO().AddKeyEvent(known, down);
}

void wr_gui_keys_release()
{
    for (const auto &pair : keys) ImGui::GetIO().AddKeyEvent(pair.imgui, false);
    send_held(0);
}

void wr_gui_keys_frame(WrGui *)
{
}

bool wr_gui_keys_seen(WrGui *)
{
    for (const auto &pair : keys)
        if (ImGui::IsKeyDown(pair.imgui)) return true; /* its end may wait in the queue */
    return false;
}

bool wr_gui_went_down(SDL_Scancode key)
{
    ImGuiKey known = key_of(key);
    return known != ImGuiKey_None && ImGui::IsKeyPressed(known, false);
}

bool wr_gui_key_repeats(SDL_Scancode key)
{
    ImGuiKey known = key_of(key);
    return known != ImGuiKey_None && ImGui::IsKeyPressed(known, true);
}

#else

void wr_gui_keys_begin()
{
    for (const auto &pair : keys) ImGui::GetIO().KeyMap[pair.imgui] = pair.sdl;
}

void wr_gui_keys_event(WrGui *gui, const SDL_KeyboardEvent *key)
{
    ImGuiIO &io = ImGui::GetIO();
    int code = key->keysym.scancode;
    if (!is_key(code)) return;
    if (key->type == SDL_KEYDOWN) {
        if (code == SDL_SCANCODE_ESCAPE) gui->close_popups = true;
        io.KeysDown[code] = gui->pressed_now[code] = true;
        gui->held_late |= key->keysym.mod & (KMOD_CTRL | KMOD_SHIFT | KMOD_ALT);
    } else if (gui->pressed_now[code]) {
        gui->released_late[code] = true; /* seen for one frame, then let go */
    } else {
        io.KeysDown[code] = false;
    }
}

void wr_gui_keys_release()
{
    ImGuiIO &io = ImGui::GetIO();
    memset(io.KeysDown, 0, sizeof io.KeysDown);
    io.KeyShift = io.KeyCtrl = io.KeyAlt = false;
}

/* Those held now, and those that were held while a key went down since the last frame: Ctrl+A counts even if
   both were let go before there was one. */
void wr_gui_keys_frame(WrGui *gui)
{
    ImGuiIO &io = ImGui::GetIO();
    int mod = (int)SDL_GetModState() | gui->held_late;
    io.KeyShift = (mod & KMOD_SHIFT) != 0;
    io.KeyCtrl = (mod & KMOD_CTRL) != 0;
    io.KeyAlt = (mod & KMOD_ALT) != 0;
    gui->held_late = 0;
}

bool wr_gui_keys_seen(WrGui *gui)
{
    bool dropped = false;
    for (int i = 0; i < WR_GUI_KEYS; i++) {
        gui->pressed_now[i] = false;
        if (!gui->released_late[i]) continue;
        ImGui::GetIO().KeysDown[i] = gui->released_late[i] = false;
        dropped = true;
    }
    return dropped;
}

bool wr_gui_went_down(SDL_Scancode key)
{
    return is_key(key) && ImGui::IsKeyPressed(key, false);
}

bool wr_gui_key_repeats(SDL_Scancode key)
{
    return is_key(key) && ImGui::IsKeyPressed(key, true);
}

#endif
