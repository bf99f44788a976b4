/* Rows by their names: their list, and the highlight of one of them. */
#include "ui/toolkit/gui_imgui.h"
#include "ui/toolkit/gui_rows.h"

#include <imgui_internal.h>

#include <stdlib.h>
#include <string.h>

#define LIT_MS 2000
#define PATIENCE 4 /* frames in which a row must appear */
#define SCROLLS 3  /* frames that scroll to a row */

/* The name of a label "12 changed###NAME" or "NAME##7" stays the same while its text changes. */
static const char *name_of(const char *label, size_t *length)
{
    const char *id = strstr(label, "###");
    if (id) label = id + 3;
    const char *end = id ? nullptr : strstr(label, "##");
    *length = end ? (size_t)(end - label) : strlen(label);
    return label;
}

static bool is_named(const char *label, const char *name)
{
    size_t length;
    const char *own = name_of(label, &length);
    return strlen(name) == length && strncmp(own, name, length) == 0;
}

static void report(WrRowText kind, const char *text)
{
    const WrGui *gui = wr_gui_current();
    char name[512];
    size_t length;
    if (!gui->rows.report || gui->as_it_is || !text) return;
    const char *own = kind == WR_ROW_TIP ? (length = strlen(text), text) : name_of(text, &length);
    if (length == 0 || length >= sizeof name) return;
    memcpy(name, own, length);
    name[length] = '\0';
    gui->rows.report(gui->rows.ctx, kind, name);
}

/* ---- the highlight ---- */

static void frame(WrLight *light, ImVec2 low, ImVec2 high)
{
    const float out = (float)wr_gui_px(3);
    low = ImVec2(low.x - out, low.y - out), high = ImVec2(high.x + out, high.y + out);
    const ImGuiWindow *window = ImGui::GetCurrentWindow();
    if (light->since == 0) light->since = SDL_GetTicks64();
    /* Rows above it that come or go later, after an undo for example, must not move it away from under the pointer. */
    else if (window->Scroll.y == light->scrolled && low.y != light->place[1])
        light->scrolls = SCROLLS;
    light->scrolled = window->Scroll.y;
    if (light->scrolls > 0) { /* sections that unfold above it move it once more */
        if (light->scrolls > 1) ImGui::SetScrollFromPosY(low.y - ImGui::GetWindowPos().y, 0.3f);
        light->scrolls--;
    }
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->PushClipRect(window->InnerRect.Min, window->InnerRect.Max, false);
    list->AddRectFilled(low, high, wr_gui_colour_u32((WR_COLOUR_ACCENT & 0xffffffu) | 0x30000000u));
    list->AddRect(low, high, wr_gui_colour_u32(WR_COLOUR_ACCENT), 0, 0, (float)wr_gui_px(2));
    list->PopClipRect();
    light->place[0] = low.x, light->place[1] = low.y;
    light->place[2] = high.x - low.x, light->place[3] = high.y - low.y;
    light->lit_in = ImGui::GetFrameCount();
}

static bool searches(const WrLight *light)
{
    return light->label[0] && light->lit_in != ImGui::GetFrameCount() &&
           (light->since == 0 || SDL_GetTicks64() - light->since < LIT_MS);
}

static bool is_lit(const char *label)
{
    const WrGui *gui = wr_gui_current();
    const WrLight *light = &gui->light;
    return searches(light) && !gui->as_it_is && is_named(label, light->label) &&
           (!light->section[0] || light->inside);
}

/* From the cursor across the rest of the area. */
static void frame_row(void)
{
    const ImVec2 at = ImGui::GetCursorScreenPos();
    frame(&wr_gui_current()->light, at,
          ImVec2(at.x + ImGui::GetContentRegionAvail().x, at.y + ImGui::GetFrameHeight()));
}

void wr_gui_row_label(const char *label)
{
    if (!label[0]) return;
    report(WR_ROW_LABEL, label);
    if (is_lit(label)) frame_row();
}

extern "C" void wr_gui_name_row(const char *label)
{
    report(WR_ROW_LABEL, label);
}

extern "C" void wr_gui_name_item(const char *label)
{
    if (is_lit(label))
        frame(&wr_gui_current()->light, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
}

void wr_gui_row_button(const char *label)
{
    report(WR_ROW_BUTTON, label);
    wr_gui_name_item(label);
}

bool wr_gui_row_section(const char *label)
{
    WrLight *light = &wr_gui_current()->light;
    report(WR_ROW_SECTION, label);
    light->inside = is_named(label, light->section);
    if (!light->inside || !searches(light)) return wr_gui_current()->rows.report != nullptr;
    if (light->waited > PATIENCE && light->since == 0) light->heading = true;
    if (light->heading) frame_row();
    return light->since == 0 || wr_gui_current()->rows.report;
}

void wr_gui_row_choices(const char *const *items, int count)
{
    for (int i = 0; i < count; i++) report(WR_ROW_CHOICE, items[i]);
}

void wr_gui_row_menu(const char *label)
{
    report(label ? WR_ROW_MENU : WR_ROW_MENU_END, label ? label : "end");
}

void wr_gui_row_tip(const char *text)
{
    report(WR_ROW_TIP, text);
}

/* A row that is in no panel now must not light up when it appears minutes later. */
void wr_gui_light_frame(WrGui *gui)
{
    WrLight *light = &gui->light;
    light->inside = false;
    if (light->label[0] && light->since == 0 && ++light->waited > 3 * PATIENCE) *light = WrLight{};
    if (light->since && SDL_GetTicks64() - light->since >= LIT_MS) *light = WrLight{};
}

extern "C" void wr_gui_light_row(WrGui *gui, const char *section, const char *label)
{
    WrLight *light = &gui->light;
    *light = WrLight{};
    light->scrolls = SCROLLS;
    light->lit_in = -1;
    SDL_utf8strlcpy(light->section, section, sizeof light->section);
    SDL_utf8strlcpy(light->label, label, sizeof light->label);
}

extern "C" double wr_gui_light_left(const WrGui *gui)
{
    const WrLight *light = &gui->light;
    if (!light->label[0]) return -1;
    if (light->since == 0 || light->scrolls > 0) return 0;
    const Uint64 passed = SDL_GetTicks64() - light->since;
    return passed < LIT_MS ? (double)(LIT_MS - passed) * 1e-3 : 0;
}

extern "C" bool wr_gui_lit_row(const WrGui *gui, float place[4])
{
    memcpy(place, gui->light.place, sizeof gui->light.place);
    return gui->light.label[0] && gui->light.since && !gui->light.heading;
}

extern "C" bool wr_gui_light_waits(const char *label)
{
    const WrLight *light = &wr_gui_current()->light;
    return light->label[0] && light->since == 0 && is_named(label, light->label);
}

/* ---- the list ---- */

extern "C" bool wr_gui_lists_rows(void)
{
    return wr_gui_current()->rows.report != nullptr;
}

/* A context of its own leaves the focus, the folds and the open lists of the window as they are. */
extern "C" void wr_gui_list_rows(WrGui *gui, int width, int height, void (*draw)(void *ctx),
                                 WrRowReport *reported, void *ctx)
try {
    WrGui *own = static_cast<WrGui *>(calloc(1, sizeof(WrGui)));
    if (!own) return;
    const ImGuiStyle style = ImGui::GetStyle();
    own->renderer = gui->renderer;
    own->kept = gui->kept;
    own->scale = gui->scale;
    own->no_icons = gui->no_icons, own->no_text = gui->no_text;
    memcpy(own->fonts, gui->fonts, sizeof own->fonts);
    own->focus.stops = gui->focus.stops; /* replaced in the next frame of the window */
    own->focus.coming = static_cast<WrKeyStop *>(calloc(WR_GUI_STOPS, sizeof(WrKeyStop)));
    own->rows.report = reported;
    own->rows.ctx = ctx;
    own->context = ImGui::CreateContext(gui->context->IO.Fonts);
    ImGui::SetCurrentContext(own->context);
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = io.LogFilename = nullptr;
    io.UserData = own;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    io.DisplaySize = ImVec2((float)width, (float)height);
    io.DeltaTime = 0.01f;
    ImGui::GetStyle() = style;
    if (own->focus.coming) {
        ImGui::NewFrame();
        ImGui::PushFont(own->fonts[WR_FONT_TEXT]);
        draw(ctx);
        ImGui::PopFont();
        ImGui::EndFrame();
    }
    ImGui::SetCurrentContext(gui->context);
    ImGui::DestroyContext(own->context);
    free(own->focus.coming);
    free(own);
}
WR_CAUGHT()
