/* Context of the widget library: style, events, frames. */
#include "ui/toolkit/gui_imgui.h"
#include "ui/toolkit/retained_frame.h"

extern "C" {
#include "base/memory.h"
}

#include <imgui_internal.h>
#include <math.h>
#include <string.h>

static_assert(sizeof(ImDrawVert) == sizeof(WrGuiVertex), "vertices are handed over as they are");
static_assert(sizeof(ImDrawIdx) == sizeof(uint16_t), "indices are handed over as they are");

WrGui *wr_gui_current(void)
{
    return static_cast<WrGui *>(ImGui::GetIO().UserData);
}

ImU32 wr_gui_colour_u32(WrColour c)
{
    return IM_COL32((c >> 16) & 255, (c >> 8) & 255, c & 255, c >> 24);
}

ImVec4 wr_gui_colour_vec4(WrColour c)
{
    return ImGui::ColorConvertU32ToFloat4(wr_gui_colour_u32(c));
}

void wr_gui_edge(ImDrawList *list, ImVec2 low, ImVec2 high)
{
    ImU32 colour = wr_gui_colour_u32(WR_COLOUR_EDGE);
    list->AddRectFilled(ImVec2(low.x + 1, low.y), ImVec2(high.x - 1, low.y + 1), colour);
    list->AddRectFilled(ImVec2(low.x + 1, high.y - 1), ImVec2(high.x - 1, high.y), colour);
    list->AddRectFilled(ImVec2(low.x, low.y + 1), ImVec2(low.x + 1, high.y - 1), colour);
    list->AddRectFilled(ImVec2(high.x - 1, low.y + 1), ImVec2(high.x, high.y - 1), colour);
}

/* ---- style ---- */

static void set_colours(ImVec4 *c)
{
    c[ImGuiCol_Text] = wr_gui_colour_vec4(WR_COLOUR_TEXT);
    c[ImGuiCol_TextDisabled] = wr_gui_colour_vec4(WR_COLOUR_FAINT);
    c[ImGuiCol_WindowBg] = c[ImGuiCol_MenuBarBg] = wr_gui_colour_vec4(WR_COLOUR_PANEL);
    c[ImGuiCol_PopupBg] = wr_gui_colour_vec4(WR_COLOUR_POPUP);
    c[ImGuiCol_Border] = wr_gui_colour_vec4(WR_COLOUR_EDGE);
    c[ImGuiCol_FrameBg] = c[ImGuiCol_ChildBg] = wr_gui_colour_vec4(WR_COLOUR_FIELD);
    c[ImGuiCol_FrameBgHovered] = c[ImGuiCol_FrameBgActive] =
        wr_gui_colour_vec4(WR_COLOUR_FIELD_HOT);
    c[ImGuiCol_Button] = wr_gui_colour_vec4(WR_COLOUR_BUTTON);
    c[ImGuiCol_ButtonHovered] = wr_gui_colour_vec4(WR_COLOUR_BUTTON_HOT);
    c[ImGuiCol_ButtonActive] = c[ImGuiCol_HeaderActive] = wr_gui_colour_vec4(WR_COLOUR_SELECTED);
    c[ImGuiCol_Header] = c[ImGuiCol_HeaderHovered] = wr_gui_colour_vec4(WR_COLOUR_SELECTED);
    c[ImGuiCol_CheckMark] = wr_gui_colour_vec4(WR_COLOUR_ACCENT);
    c[ImGuiCol_Separator] = wr_gui_colour_vec4(WR_COLOUR_EDGE);
    c[ImGuiCol_TextSelectedBg] = wr_gui_colour_vec4(WR_COLOUR_SELECTED);
    c[ImGuiCol_ScrollbarBg] = wr_gui_colour_vec4(0x00000000u);
    c[ImGuiCol_ScrollbarGrab] = wr_gui_colour_vec4(WR_COLOUR_GRAB);
    c[ImGuiCol_ScrollbarGrabHovered] = wr_gui_colour_vec4(WR_COLOUR_GRAB_HOT);
    c[ImGuiCol_ScrollbarGrabActive] = wr_gui_colour_vec4(WR_COLOUR_GRAB_HELD);
    c[ImGuiCol_ModalWindowDimBg] = wr_gui_colour_vec4(0x60000000u);
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = wr_gui_colour_vec4(WR_COLOUR_BAR);
}

static void set_style(double scale)
{
    ImGuiStyle style;
    style.WindowRounding = 0.0f;
    style.ChildRounding = style.FrameRounding = 0.0f;
    style.PopupRounding = 4.0f;
    style.WindowBorderSize = 0.0f;
    style.CircleTessellationMaxError = 0.1f;
    style.FrameBorderSize = 0.0f;
    style.FramePadding = ImVec2(8.0f, 2.0f);
    style.ItemSpacing = ImVec2(8.0f, 8.0f);
    style.ItemInnerSpacing = ImVec2(6.0f, 4.0f);
    style.WindowPadding = ImVec2(12.0f, 12.0f);
    style.ScrollbarSize = 10.0f;
    style.ScrollbarRounding = 5.0f;
    style.ScaleAllSizes((float)scale);
    style.ChildBorderSize = style.PopupBorderSize = 1.0f;
    set_colours(style.Colors);
    ImGui::GetStyle() = style;
}

/* ---- creation ---- */

static const char *get_clipboard(void *ctx)
{
    /* stores a copy, since the text must outlive the call */
    WrGui *gui = static_cast<WrGui *>(ctx);
    char *held = SDL_GetClipboardText();
    SDL_utf8strlcpy(gui->clipboard, held ? held : "", sizeof gui->clipboard);
    SDL_free(held);
    return gui->clipboard;
}

static void set_clipboard(void *, const char *text)
{
    SDL_SetClipboardText(text);
}

static void settle_io(WrGui *gui)
{
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = io.LogFilename = nullptr;
    io.UserData = gui;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    io.ClipboardUserData = gui;
    io.GetClipboardTextFn = get_clipboard;
    io.SetClipboardTextFn = set_clipboard;
    wr_gui_keys_begin();
}

extern "C" WrGui *wr_gui_new(SDL_Renderer *renderer, double scale, char **font_files, WrError *err)
try {
    WrGui *gui = static_cast<WrGui *>(calloc(1, sizeof(WrGui)));
    if (!gui) {
        wr_fail(err, "not enough memory for the window");
        return nullptr;
    }
    gui->focus.stops = static_cast<WrKeyStop *>(calloc(WR_GUI_STOPS, sizeof(WrKeyStop)));
    gui->focus.coming = static_cast<WrKeyStop *>(calloc(WR_GUI_STOPS, sizeof(WrKeyStop)));
    if (!gui->focus.stops || !gui->focus.coming) {
        wr_fail(err, "not enough memory for the window");
        free(gui->focus.stops);
        free(gui->focus.coming);
        free(gui);
        return nullptr;
    }
    gui->renderer = renderer;
    gui->font_files = font_files;
    gui->kept = wr_retained_frame_new(renderer);
    gui->context = ImGui::CreateContext();
    settle_io(gui);
    if (!wr_gui_set_scale(gui, scale, err)) {
        wr_gui_free(gui);
        return nullptr;
    }
    return gui;
}
WR_CAUGHT(nullptr)

extern "C" void wr_gui_use_folds(WrGui *gui, char **folds)
{
    gui->folds = folds;
}

extern "C" void wr_gui_free(WrGui *gui)
try {
    if (!gui) return;
    ImGui::DestroyContext(gui->context);
    if (gui->atlas) SDL_DestroyTexture(gui->atlas);
    wr_retained_frame_free(gui->kept);
    free(gui->focus.stops);
    free(gui->focus.coming);
    wr_free(gui->typed_on);
    free(gui);
}
WR_CAUGHT()

extern "C" bool wr_gui_set_scale(WrGui *gui, double scale, WrError *err)
try {
    gui->scale = scale < 0.75 ? 0.75 : scale > 4.0 ? 4.0 : scale;
    set_style(gui->scale);
    return wr_gui_build_fonts(gui, err);
}
WR_CAUGHT(false)

/* ---- events ---- */

static int button_index(int button)
{
    return button == SDL_BUTTON_LEFT     ? 0
           : button == SDL_BUTTON_RIGHT  ? 1
           : button == SDL_BUTTON_MIDDLE ? 2
                                         : -1;
}

extern "C" void wr_gui_event(WrGui *gui, const SDL_Event *event)
try {
    ImGuiIO &io = ImGui::GetIO();
    int button;
    if (wr_gui_focus_event(gui, event)) return;
    switch (event->type) {
    case SDL_MOUSEMOTION:
        io.MousePos = gui->pointer = ImVec2((float)event->motion.x, (float)event->motion.y);
        break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        io.MousePos = gui->pointer = ImVec2((float)event->button.x, (float)event->button.y);
        button = button_index(event->button.button);
        if (button < 0) break;
        if (event->type == SDL_MOUSEBUTTONUP) gui->let_go_at = gui->pointer;
        else if (io.MouseDown[button] && !gui->held[button]) gui->again[button] = true;
        gui->held[button] = event->type == SDL_MOUSEBUTTONDOWN;
        if (button == 0 && gui->held[0]) gui->clicks = event->button.clicks;
        if (gui->held[button]) gui->pressed[button] = true;
        break;
    case SDL_MOUSEWHEEL:
        io.MouseWheel += event->wheel.preciseY;
        io.MouseWheelH += event->wheel.preciseX;
        break;
    case SDL_TEXTINPUT: wr_gui_keys_letters(gui, event->text.text); break;
    case SDL_KEYDOWN:
    case SDL_KEYUP: wr_gui_keys_event(gui, &event->key); break;
    case SDL_WINDOWEVENT:
        if (event->window.event == SDL_WINDOWEVENT_LEAVE) io.MousePos = ImVec2(-FLT_MAX, -FLT_MAX);
        break;
    default: break;
    }
}
WR_CAUGHT()

extern "C" void wr_gui_release_all(WrGui *gui)
try {
    memset(gui->held, 0, sizeof gui->held);
    wr_gui_keys_release(gui);
}
WR_CAUGHT()

extern "C" bool wr_gui_owns_point(const WrGui *, int x, int y)
try {
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    if (g.OpenPopupStack.Size > 0) return true;
    ImVec2 point((float)x, (float)y);
    for (const ImGuiWindow *window : g.Windows)
        if (window->Active && !(window->Flags & ImGuiWindowFlags_NoMouseInputs) &&
            !window->ParentWindow && window->Rect().Contains(point))
            return true;
    return false;
}
WR_CAUGHT(false)

/* ---- displayed frame ---- */

static bool is_hidden(const ImGuiWindow *window)
{
    return window->HiddenFramesCanSkipItems > 0 || window->HiddenFramesCannotSkipItems > 0;
}

static void note_shown(WrGui *gui)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    gui->shown_count = 0;
    gui->shown_top = g.OpenPopupStack.Size > 0 ? g.OpenPopupStack.back().PopupId : 0;
    for (const ImGuiWindow *window : g.Windows) {
        const bool owns = window->Active && !is_hidden(window) && !wr_gui_is_list(window) &&
                          !(window->Flags & ImGuiWindowFlags_NoMouseInputs);
        if (!owns || gui->shown_count == WR_GUI_SHOWN) continue;
        const ImRect r = window->Rect();
        gui->shown[gui->shown_count++] =
            WrShownWindow{ window->ID, r.Min.x, r.Min.y, r.Max.x, r.Max.y };
    }
}

static bool covers(const WrShownWindow &window, float x, float y)
{
    return x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
}

extern "C" unsigned wr_gui_widget_at(const WrGui *gui, int px, int py)
try {
    const float x = (float)px, y = (float)py;
    const WrShownWindow *window = nullptr;
    for (int i = gui->shown_count - 1; i >= 0 && !window; i--)
        if (covers(gui->shown[i], x, y)) window = &gui->shown[i];
    ImGuiID id = window ? window->id : 0;
    for (int i = 0; window && i < gui->focus.count; i++) {
        const WrKeyStop *s = &gui->focus.stops[i];
        const ImGuiWindow *list =
            s->part == window->id ? ImGui::FindWindowByID(s->window) : nullptr;
        if (list && x >= s->x0 && x < s->x1 && y >= s->y0 && y < s->y1 &&
            list->OuterRectClipped.Contains(ImVec2(x, y)))
            id = s->id;
    }
    return id ^ gui->shown_top * 31u;
}
WR_CAUGHT(0)

extern "C" bool wr_gui_holds_mouse(const WrGui *)
{
    return ImGui::GetCurrentContext()->ActiveId != 0 && ImGui::GetIO().MouseDown[0];
}

extern "C" bool wr_gui_wants_text(const WrGui *)
{
    /* Between two frames ImGui's own flag is one frame late. */
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    return g.WithinFrameScope ? g.IO.WantTextInput
                              : g.WantTextInputNextFrame == 1 && g.ActiveId != 0;
}

extern "C" bool wr_gui_has_pending_timer(const WrGui *gui)
{
    return gui->tip_waits || gui->drag_scrolls;
}

static int dialogs_open()
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    bool modal = g.OpenPopupStack.Size > 0 && g.OpenPopupStack[0].Window &&
                 (g.OpenPopupStack[0].Window->Flags & ImGuiWindowFlags_Modal);
    return modal ? 1 : 0;
}

extern "C" bool wr_gui_popup_open_now(const WrGui *)
{
    return ImGui::GetCurrentContext()->OpenPopupStack.Size > dialogs_open();
}

/* A part of a panel that is scrolled out of sight, such as a text that is being edited: hidden in every frame. */
static bool is_scrolled_away(const ImGuiWindow *window)
{
    const ImRect *seen = &window->OuterRectClipped;
    return (window->Flags & ImGuiWindowFlags_ChildWindow) &&
           (seen->Min.x >= seen->Max.x || seen->Min.y >= seen->Max.y);
}

/* Auto-sized windows are measured in an invisible first frame. */
static bool window_comes(const ImGuiContext &g)
{
    for (const ImGuiWindow *window : g.Windows)
        if (window->Active && is_hidden(window) && !is_scrolled_away(window)) return true;
    return false;
}

/* Sum of the present and ideal sizes of auto-sized windows: it changes if one of them does. Dialogs request
   auto-sizing in every frame. */
static double fitted_sizes(const ImGuiContext &g)
{
    double sum = 0.0;
    for (const ImGuiWindow *window : g.Windows) {
        if (!window->Active || (window->AutoFitFramesX <= 0 && window->AutoFitFramesY <= 0))
            continue;
        sum = sum * 3.0 + (double)window->Size.x + 7.0 * (double)window->Size.y;
        ImVec2 end = window->DC.CursorMaxPos;
        sum = sum * 3.0 + (double)(end.x - window->Pos.x) + 7.0 * (double)(end.y - window->Pos.y);
    }
    return sum;
}

extern "C" bool wr_gui_unsettled(const WrGui *gui)
{
    const ImGuiContext &g = *ImGui::GetCurrentContext();
    for (int i = 0; i < 3; i++)
        if (gui->pressed[i] || g.IO.MouseDown[i] != gui->held[i]) return true;
    bool dims = g.DimBgRatio > 0.0f && g.DimBgRatio < 1.0f;
    const WrFocus *focus = &gui->focus;
    if (focus->waiting_count > 0 || (focus->stepped && focus->arrow_let_go)) return true;
    if (gui->typing_focus || focus->moved || wr_gui_light_left(gui) == 0) return true;
    if (gui->fold_frame > ImGui::GetFrameCount()) return true;
    return gui->keys_dropped || gui->popups != g.OpenPopupStack.Size || dims || gui->fits ||
           window_comes(g);
}

extern "C" SDL_SystemCursor wr_gui_cursor(const WrGui *)
{
    switch (ImGui::GetMouseCursor()) {
    case ImGuiMouseCursor_TextInput: return SDL_SYSTEM_CURSOR_IBEAM;
    case ImGuiMouseCursor_ResizeEW: return SDL_SYSTEM_CURSOR_SIZEWE;
    case ImGuiMouseCursor_ResizeNS: return SDL_SYSTEM_CURSOR_SIZENS;
    case ImGuiMouseCursor_Hand: return SDL_SYSTEM_CURSOR_HAND;
    default: return SDL_SYSTEM_CURSOR_ARROW;
    }
}

/* ---- frames ---- */

extern "C" void wr_gui_frame_begin(WrGui *gui, int width, int height, double seconds)
try {
    ImGuiIO &io = ImGui::GetIO();
    io.DisplaySize = ImVec2((float)width, (float)height);
    wr_retained_frame_clear(gui->kept, WR_COLOUR_BAR);
    bool lets_go = false;
    io.DeltaTime = (float)(seconds > 1e-4 ? (seconds < 0.5 ? seconds : 0.5) : 1e-4);
    for (int i = 0; i < 3;
         i++) { /* pressed and released since the last frame: pressed for one frame */
        io.MouseDown[i] = !gui->again[i] && (gui->held[i] || gui->pressed[i]);
        if (gui->again[i]) lets_go = true;
        else gui->pressed[i] = false;
        gui->again[i] = false;
    }
    if (lets_go) io.MousePos = gui->let_go_at;
    else if (gui->let_go) io.MousePos = gui->pointer;
    gui->let_go = lets_go;
    wr_gui_keys_frame(gui);
    wr_gui_focus_before(gui);
    ImGui::NewFrame();
    ImGuiContext &g = *ImGui::GetCurrentContext();
    gui->popups = g.OpenPopupStack.Size;
    gui->tip_waits = gui->drag_scrolls = false;
    int keep = dialogs_open(); /* close lists of a dialog; the dialog decides for itself */
    gui->list_open = g.OpenPopupStack.Size > keep;
    if (gui->close_popups && g.OpenPopupStack.Size > keep) ImGui::ClosePopupToLevel(keep, true);
    gui->close_popups = false;
    gui->keys_dropped = wr_gui_keys_seen(gui);
    wr_gui_focus_begun(gui);
    wr_gui_light_frame(gui);
    ImGui::PushFont(gui->fonts[WR_FONT_TEXT]);
}
WR_CAUGHT()

extern "C" void wr_gui_frame_end(WrGui *gui)
try {
    ImGui::PopFont();
    wr_gui_focus_end(gui);
    ImGui::Render();
    note_shown(gui);
    if (gui->typing_focus && gui->typing_frame != ImGui::GetFrameCount()) {
        gui->typing = 0; /* its field is gone */
        gui->typing_focus = false;
    }
    double sizes = fitted_sizes(*ImGui::GetCurrentContext());
    gui->fits = sizes != gui->fitted;
    gui->fitted = sizes;
    if (wr_gui_reports_all || wr_gui_unseen) {
        wr_retained_frame_drop(gui->kept);
        return;
    }
    ImDrawData *data = ImGui::GetDrawData();
    ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
    for (int n = 0; n < data->CmdListsCount; n++) {
        const ImDrawList *list = data->CmdLists[n];
        const auto *vertices = reinterpret_cast<const WrGuiVertex *>(list->VtxBuffer.Data);
        for (const ImDrawCmd &cmd : list->CmdBuffer) {
            if (cmd.UserCallback) continue;
            WrGuiCommand command = {};
            command.clip = { (int)cmd.ClipRect.x, (int)cmd.ClipRect.y,
                             (int)(cmd.ClipRect.z - cmd.ClipRect.x),
                             (int)(cmd.ClipRect.w - cmd.ClipRect.y) };
            if (command.clip.w <= 0 || command.clip.h <= 0) continue;
            command.texture = wr_gui_texture_of(cmd.GetTexID());
            command.white_u = white.x;
            command.white_v = white.y;
            command.vertices = vertices + cmd.VtxOffset;
            command.indices = list->IdxBuffer.Data + cmd.IdxOffset;
            command.index_count = (int)cmd.ElemCount;
            wr_retained_frame_command(gui->kept, &command);
        }
    }
    wr_retained_frame_end(gui->kept);
}
WR_CAUGHT()

extern "C" WrRetainedFrame *wr_gui_kept(const WrGui *gui)
{
    return gui->kept;
}

extern "C" double wr_gui_scale(void)
{
    return wr_gui_current()->scale;
}

extern "C" int wr_gui_px(double units)
{
    return (int)lround(units * wr_gui_current()->scale);
}
