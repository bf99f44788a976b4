/* Passing of keys to ImGui. */
#include "ui/toolkit/gui_imgui.h"

extern "C" {
#include "base/memory.h"
}

#include <stdio.h>
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

/* ---- versions of ImGui: key events and codes of its own since 1.87, before that an array by the platform's codes ---- */

#if IMGUI_VERSION_NUM >= 18700

#if IMGUI_VERSION_NUM >= 18900
#define MOD(name) ImGuiMod_##name
#else
#define MOD(name) ImGuiKey_Mod##name
#endif

/* ImGui would spread the events between two frames over several frames by rules of its own. */
void wr_gui_keys_begin()
{
    ImGui::GetIO().ConfigInputTrickleEventQueue = false;
}

static void send_held(int mod)
{
    ImGuiIO &io = ImGui::GetIO();
    io.AddKeyEvent(MOD(Ctrl), (mod & KMOD_CTRL) != 0);
    io.AddKeyEvent(MOD(Shift), (mod & KMOD_SHIFT) != 0);
    io.AddKeyEvent(MOD(Alt), (mod & KMOD_ALT) != 0);
}

static void send_keys(const WrGui *gui)
{
    for (const auto &pair : keys) ImGui::GetIO().AddKeyEvent(pair.imgui, gui->down[pair.sdl]);
}

static bool is_pressed(int code, bool repeated)
{
    for (const auto &pair : keys)
        if (pair.sdl == code) return ImGui::IsKeyPressed(pair.imgui, repeated);
    return false;
}

#else

void wr_gui_keys_begin()
{
    for (const auto &pair : keys) ImGui::GetIO().KeyMap[pair.imgui] = pair.sdl;
}

static void send_held(int mod)
{
    ImGuiIO &io = ImGui::GetIO();
    io.KeyShift = (mod & KMOD_SHIFT) != 0;
    io.KeyCtrl = (mod & KMOD_CTRL) != 0;
    io.KeyAlt = (mod & KMOD_ALT) != 0;
}

static void send_keys(const WrGui *gui)
{
    static_assert(sizeof gui->down == sizeof ImGui::GetIO().KeysDown, "one value for each key");
    memcpy(ImGui::GetIO().KeysDown, gui->down, sizeof gui->down);
}

static bool is_pressed(int code, bool repeated)
{
    return is_key(code) && ImGui::IsKeyPressed(code, repeated);
}

#endif

/* ---- the queue ---- */

/* From the events between two frames ImGui reads all letters first (none while Ctrl is held), and only one of the
   keys that move or delete. So a frame gets letters, or one such key; the rest waits for the next frame, which
   follows at once. */

static bool is_held_key(int code)
{
    return code >= SDL_SCANCODE_LCTRL && code <= SDL_SCANCODE_RGUI;
}

/* True for a key that has an effect in a text field besides its letters. */
static bool acts(const SDL_Keysym &key)
{
    if (key.mod & (KMOD_CTRL | KMOD_ALT | KMOD_GUI)) return true;
    if (key.scancode == SDL_SCANCODE_SPACE || key.scancode < SDL_SCANCODE_RETURN) return false;
    for (const auto &pair : keys)
        if (pair.sdl == key.scancode) return true;
    return false;
}

/* True for a key whose effect in a text field is only letters, or Shift for them: it may be pressed several times in
   a frame. */
static bool tells_by_letters(const SDL_Keysym &key)
{
    bool shift = key.scancode == SDL_SCANCODE_LSHIFT || key.scancode == SDL_SCANCODE_RSHIFT;
    return ImGui::GetIO().WantTextInput && (shift || (!is_held_key(key.scancode) && !acts(key)));
}

static void keep(WrGui *gui, const WrTyped &typed)
{
    if (gui->typed_count == gui->typed_room) {
        int room = gui->typed_room > 0 ? 2 * gui->typed_room : 64;
        gui->typed_on = static_cast<WrTyped *>(
            wr_realloc(gui->typed_on, (size_t)gui->typed_room, (size_t)room, sizeof typed));
        gui->typed_room = room;
    }
    gui->typed_on[gui->typed_count++] = typed;
}

void wr_gui_keys_event(WrGui *gui, const SDL_KeyboardEvent *key)
{
    if (!is_key(key->keysym.scancode)) return;
    keep(gui, WrTyped{ key->keysym, key->type == SDL_KEYDOWN, "" });
}

void wr_gui_keys_letters(WrGui *gui, const char *utf8)
{
    WrTyped typed = {};
    snprintf(typed.letters, sizeof typed.letters, "%s", utf8);
    if (typed.letters[0]) keep(gui, typed);
}

void wr_gui_keys_release(WrGui *gui)
{
    memset(gui->down, 0, sizeof gui->down);
    memset(gui->released_late, 0, sizeof gui->released_late);
    send_keys(gui);
    send_held(0);
    int letters = 0;
    for (int i = 0; i < gui->typed_count; i++)
        if (gui->typed_on[i].letters[0]) gui->typed_on[letters++] = gui->typed_on[i];
    gui->typed_count = letters; /* typed earlier, whatever gets the keys now */
    gui->typed_held = 0;
}

static void key_down(WrGui *gui, const SDL_Keysym &key)
{
    int code = key.scancode;
    if (code == SDL_SCANCODE_ESCAPE) gui->close_popups = true;
    gui->down[code] = gui->pressed_now[code] = true;
    gui->released_late[code] = false;
    if (!is_held_key(code)) gui->held_late |= key.mod & (KMOD_CTRL | KMOD_SHIFT | KMOD_ALT);
}

static void key_up(WrGui *gui, int code)
{
    if (gui->pressed_now[code])
        gui->released_late[code] = true; /* pressed for one frame, then released */
    else gui->down[code] = false;
}

/* Move queued input to the next frame, from the first item. */
static void take_typed(WrGui *gui)
{
    bool letters = false, acted = false;
    int taken = 0;
    for (; taken < gui->typed_count; taken++) {
        const WrTyped &typed = gui->typed_on[taken];
        if (typed.letters[0]) {
            if (acted) break;
            ImGui::GetIO().AddInputCharactersUTF8(typed.letters);
            letters = true;
            continue;
        }
        if (typed.down) {
            int code = typed.key.scancode;
            bool down = gui->down[code];
            if (down && !gui->released_late[code]) continue; /* held: ImGui repeats it itself */
            bool act = !is_held_key(code) && acts(typed.key);
            /* Released since the last frame: the frame must first see the release. Not for letters, which are passed
               as text. */
            bool anew = down || gui->was_down[code];
            if ((anew && !tells_by_letters(typed.key)) || (act && acted) ||
                (letters && acts(typed.key)))
                break;
            acted |= act;
            key_down(gui, typed.key);
        } else {
            key_up(gui, typed.key.scancode);
        }
        gui->typed_held = typed.key.mod;
    }
    if (taken == 0) return;
    gui->typed_count -= taken;
    memmove(gui->typed_on, gui->typed_on + taken, (size_t)gui->typed_count * sizeof *gui->typed_on);
}

/* Modifiers: those held at the newest key event, and those held during a key press since the last frame, so that
   Ctrl+A works even if both were released before the frame. */
void wr_gui_keys_frame(WrGui *gui)
{
    if (ImGui::GetCurrentContext() != gui->context) return;
    take_typed(gui);
    send_held(gui->typed_held | gui->held_late);
    send_keys(gui);
    memcpy(gui->was_down, gui->down, sizeof gui->down);
    gui->held_late = 0;
}

bool wr_gui_keys_seen(WrGui *gui)
{
    bool dropped = gui->typed_count > 0;
    for (int i = 0; i < WR_GUI_KEYS; i++) {
        gui->pressed_now[i] = false;
        if (!gui->released_late[i]) continue;
        gui->down[i] = gui->released_late[i] = false;
        dropped = true;
    }
    return dropped;
}

bool wr_gui_went_down(SDL_Scancode key)
{
    return is_pressed(key, false);
}

bool wr_gui_key_repeats(SDL_Scancode key)
{
    return is_pressed(key, true);
}
