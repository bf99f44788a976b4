/* Translation of widget texts, and reports of texts that are too wide. */
#include "ui/toolkit/gui_imgui.h"

#include <imgui_internal.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

void (*wr_gui_cut)(const char *text, double width, double room);
bool wr_gui_reports_all, wr_gui_unseen;

extern "C" void wr_gui_as_it_is(bool on)
{
    wr_gui_current()->as_it_is = on;
}

const char *wr_gui_said(const char *text)
{
    return wr_gui_current()->as_it_is ? text : wr_words(text);
}

/* Test mode: stand-in for a popup that is not open. */
bool wr_gui_popup_stand_in(const char *name)
{
    if (!wr_gui_reports_all) return false;
    char own[128]; /* a dialog or an area may have the same name */
    snprintf(own, sizeof own, "##open_%.100s", name);
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::Begin(own, nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize);
    return true;
}

extern "C" void wr_gui_next_id(const char *id)
{
    wr_gui_current()->next_id = id;
}

const char *wr_gui_labelled(const char *label, char (&buffer)[320])
{
    WrGui *gui = wr_gui_current();
    if (gui->next_id) {
        snprintf(buffer, sizeof buffer, "%.250s###%.60s", wr_gui_said(label), gui->next_id);
        gui->next_id = nullptr;
        return buffer;
    }
    /* "Next##tour" has a translation of its own, "Weiter##tour": the same word may be another elsewhere. That of a composed
       label, "12 changed###NAME", is in its words. */
    char seen[256];
    const char *id = strstr(label, "##"), *looked = label;
    const size_t length = id ? (size_t)(id - label) : strlen(label);
    if (length == 0 || length >= sizeof seen) return label;
    if (id && id[2] == '#') {
        memcpy(seen, label, length);
        seen[length] = '\0';
        looked = seen;
    }
    const char *said = wr_gui_said(looked), *end = strstr(said, "##");
    if (said == looked) return label;
    if (looked == seen) snprintf(buffer, sizeof buffer, "%.250s%.60s", said, id);
    else
        snprintf(buffer, sizeof buffer, "%.*s###%.60s", end ? (int)(end - said) : 250, said, label);
    return buffer;
}

void wr_gui_fits(const char *text, float width, float room)
{
    if (wr_gui_cut && !wr_gui_current()->as_it_is && width > room + 1.0f)
        wr_gui_cut(text, (double)width, (double)room);
}

/* Uses the clip rectangle, which is narrower than the window if it scrolls. */
void wr_gui_fits_window(const char *text)
{
    if (!wr_gui_cut) return;
    const ImGuiWindow *window = ImGui::GetCurrentWindow();
    if (window->SkipItems || window->HiddenFramesCanSkipItems > 0 ||
        window->HiddenFramesCannotSkipItems > 0)
        return;
    if (window->Flags & ImGuiWindowFlags_AlwaysAutoResize) return; /* it grows with its content */
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    wr_gui_fits(text, high.x - low.x, window->ClipRect.Max.x - low.x);
}

float wr_gui_row_room(float width)
{
    const ImGuiWindow *window = ImGui::GetCurrentWindow();
    const float room = ImGui::GetContentRegionAvail().x;
    const ImGuiWindowFlags grows = ImGuiWindowFlags_AlwaysAutoResize;
    if (window->Flags & (ImGuiWindowFlags_NoScrollWithMouse | grows)) return FLT_MAX; /* a bar */
    const float left = window->Pos.x + window->DC.Indent.x + window->DC.ColumnsOffset.x;
    const bool begun = window->DC.CursorPos.x > left + 0.5f &&
                       fabsf(window->DC.CursorPos.y - window->DC.CursorPosPrevLine.y) < 0.5f;
    if (width <= room || !begun) return room;
    ImGui::NewLine();
    return ImGui::GetContentRegionAvail().x;
}
