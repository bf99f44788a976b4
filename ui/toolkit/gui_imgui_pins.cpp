/* Pinned rows: a panel is drawn a second time with all other rows skipped. A row is a label with the widgets in its
   line, or a check with its text. */
#include "ui/toolkit/gui_imgui.h"

extern "C" {
#include "base/memory.h"
}

#include <imgui_internal.h>
#include <stdio.h>
#include <string.h>

/* "AREA/SECTION/LABEL" of a row. */
static void row_name(const WrGui *gui, const char *label, char (&name)[WR_GUI_PIN])
{
    char area[WR_GUI_SCOPE];
    wr_gui_area_name(gui->pinning ? gui->pin_area : gui->scope, area);
    snprintf(name, sizeof name, "%s/%.80s/%.*s", area, gui->section, (int)strcspn(label, "#"),
             label);
}

static int find(const WrGui *gui, const char *name)
{
    for (int i = 0; gui->pins && i < gui->pins_most && gui->pins[i]; i++)
        if (strcmp(gui->pins[i], name) == 0) return i;
    return -1;
}

static void set_pinned(WrGui *gui, const char *name, bool pinned)
{
    const int at = find(gui, name);
    int count = 0;
    while (count < gui->pins_most && gui->pins[count]) count++;
    if (pinned && at < 0 && count < gui->pins_most) gui->pins[count] = wr_strdup(name);
    if (pinned || at < 0) return;
    wr_free(gui->pins[at]);
    memmove(gui->pins + at, gui->pins + at + 1, (size_t)(count - at - 1) * sizeof *gui->pins);
    gui->pins[count - 1] = nullptr;
}

/* While rows are skipped, widgets neither work nor move the place of the next one; their drawing is clipped. */
static void skip(WrGui *gui, bool skips)
{
    ImGuiWindow *window = ImGui::GetCurrentWindow();
    if (gui->pin_skips == skips) return;
    gui->pin_skips = window->SkipItems = skips;
    if (skips) {
        gui->pin_cursor = window->DC.CursorPos;
        gui->pin_end = window->DC.CursorMaxPos;
        ImGui::GetCurrentContext()->LastItemData = ImGuiLastItemData();
        ImGui::PushClipRect(ImVec2(0, 0), ImVec2(0, 0), false);
    } else {
        ImGui::PopClipRect();
        window->DC.CursorPos = gui->pin_cursor;
        window->DC.CursorMaxPos = gui->pin_end;
    }
}

void wr_gui_pin_step()
{
    WrGui *gui = wr_gui_current();
    if (!gui->pinning || gui->pin_skips) return;
    if (ImGui::GetCurrentWindow()->DC.CursorPos.y >= gui->pin_low) skip(gui, true);
}

void wr_gui_pin_row(const char *label, bool two_lines)
{
    WrGui *gui = wr_gui_current();
    ImGuiWindow *window = ImGui::GetCurrentWindow();
    char name[WR_GUI_PIN];
    const float tall = ImGui::GetFrameHeight();
    if (!gui->pins || (!gui->pinning && !gui->pinnable)) return;
    row_name(gui, label, name);
    if (gui->pinning) {
        skip(gui, !label[0] || find(gui, name) < 0);
        gui->pin_low = window->DC.CursorPos.y + tall * (two_lines ? 1.5f : 0.5f);
        if (gui->pin_skips) return;
    }
    const float top = window->DC.CursorPos.y, left = window->Pos.x;
    const ImRect row(left, top, left + window->Size.x, top + (two_lines ? 2 * tall : tall));
    const bool asked = ImGui::IsMouseClicked(1) && ImGui::IsWindowHovered() &&
                       row.Contains(ImGui::GetIO().MousePos);
    if (!label[0] || !asked) return;
    snprintf(gui->pin_asked, sizeof gui->pin_asked, "%s", name);
    gui->pin_opens = true;
}

/* At the end of an area: the menu of the row that was pressed with the right button. */
void wr_gui_pin_menu()
{
    WrGui *gui = wr_gui_current();
    if (!gui->pins || gui->floating) return;
    if (gui->pin_opens) ImGui::OpenPopup("##pin");
    gui->pin_opens = false;
    if (!gui->pin_asked[0] || !wr_gui_popup_begin("##pin")) return;
    const bool pinned = find(gui, gui->pin_asked) >= 0;
    if (wr_gui_menu_item(pinned ? "Unpin" : "Pin to the top", nullptr, false, true))
        set_pinned(gui, gui->pin_asked, !pinned);
    wr_gui_popup_end();
}

extern "C" void wr_gui_use_pins(WrGui *gui, char **pins, int most)
{
    gui->pins = pins;
    gui->pins_most = most;
}

extern "C" void wr_gui_pinnable(bool on)
{
    wr_gui_current()->pinnable = on;
}

extern "C" bool wr_gui_has_pins(const char *area)
{
    const WrGui *gui = wr_gui_current();
    const size_t length = strlen(area);
    for (int i = 0; gui->pins && i < gui->pins_most && gui->pins[i]; i++)
        if (strncmp(gui->pins[i], area, length) == 0 && gui->pins[i][length] == '/') return true;
    return false;
}

extern "C" void wr_gui_pins_begin(const char *area)
{
    WrGui *gui = wr_gui_current();
    ImGui::PushID(area);
    snprintf(gui->pin_area, sizeof gui->pin_area, "%s", area);
    gui->section[0] = '\0';
    gui->pinning = true;
    skip(gui, true);
}

extern "C" void wr_gui_pins_end(void)
{
    WrGui *gui = wr_gui_current();
    skip(gui, false);
    gui->pinning = false;
    ImGui::PopID();
}
