/* gui_imgui_versions.hpp - names that differ between versions of Dear ImGui, 1.86 to 1.92. Keys differ too
   (gui_imgui_keys.cpp). Private to the gui_imgui*.cpp files. */
#pragma once
#include <SDL.h>
#include <imgui.h>
#include <imgui_freetype.h>
#include <imgui_internal.h>
#include <stdint.h>

inline float wr_gui_size_of(const ImFont *font)
{
#if IMGUI_VERSION_NUM >= 19200
    return font->LegacySize;
#else
    return font->FontSize;
#endif
}

/* The rasterised glyphs of a font; after a change of their advances. */
inline ImVector<ImFontGlyph> &wr_gui_glyphs(ImFont *font)
{
#if IMGUI_VERSION_NUM >= 19200
    return font->GetFontBaked(font->LegacySize)->Glyphs;
#else
    return font->Glyphs;
#endif
}

inline void wr_gui_glyphs_changed(ImFont *font)
{
#if IMGUI_VERSION_NUM >= 19200
    ImFontBaked *baked = font->GetFontBaked(font->LegacySize);
    for (const ImFontGlyph &glyph : baked->Glyphs)
        baked->IndexAdvanceX[(int)glyph.Codepoint] = glyph.AdvanceX;
#else
    font->BuildLookupTable();
#endif
}

/* The fonts are rasterised and have their texture. Early versions free the font files; 1.92 loses the glyphs with them, and
   requires an update before a second context draws with the atlas. */
inline void wr_gui_fonts_built(ImFontAtlas *atlas)
{
#if IMGUI_VERSION_NUM >= 19200
    ImFontAtlasUpdateNewFrame(atlas, ImGui::GetFrameCount(), false);
#else
    atlas->ClearInputData();
#endif
}

/* Snap stems to whole pixels only vertically, so that letter spacing is unchanged. */
inline void wr_gui_light_hinting(ImFontAtlas *atlas)
{
#if IMGUI_VERSION_NUM >= 19200
    atlas->SetFontLoader(ImGuiFreeType::GetFontLoader());
    atlas->FontLoaderFlags = ImGuiFreeTypeLoaderFlags_LightHinting;
#else
    atlas->FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    atlas->FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
#endif
}

/* A child window with the padding of windows. */
inline bool wr_gui_begin_part(const char *name, float w, float h, ImGuiWindowFlags flags)
{
#if IMGUI_VERSION_NUM >= 19000
    return ImGui::BeginChild(name, ImVec2(w, h), ImGuiChildFlags_AlwaysUseWindowPadding, flags);
#else
    return ImGui::BeginChild(name, ImVec2(w, h), false,
                             flags | ImGuiWindowFlags_AlwaysUseWindowPadding);
#endif
}

/* Press an item in the next frame: ActivateItem in early versions, ActivateItemByID in later ones. */
inline void wr_gui_activate(ImGuiID id)
{
    ImGuiContext &g = *ImGui::GetCurrentContext();
    g.NavNextActivateId = id;
    g.NavNextActivateFlags = 0;
}

/* Members by their new names if the struct has them, else by the old ones: the type of the second argument prefers
   the first function. */
template <typename Context>
auto wr_gui_ignores_hover(Context &g, int) -> decltype((g.NavHighlightItemUnderNav))
{
    return g.NavHighlightItemUnderNav;
}

template <typename Context>
auto wr_gui_ignores_hover(Context &g, long) -> decltype((g.NavDisableMouseHover))
{
    return g.NavDisableMouseHover;
}

template <typename Context>
auto wr_gui_hovers_disabled(Context &g, int) -> decltype((g.HoveredIdIsDisabled))
{
    return g.HoveredIdIsDisabled;
}

template <typename Context>
auto wr_gui_hovers_disabled(Context &g, long) -> decltype((g.HoveredIdDisabled))
{
    return g.HoveredIdDisabled;
}

template <typename Item> auto wr_gui_flags_of(const Item &item, int) -> decltype(item.ItemFlags)
{
    return item.ItemFlags;
}

template <typename Item> auto wr_gui_flags_of(const Item &item, long) -> decltype(item.InFlags)
{
    return item.InFlags;
}

/* Until the pointer moves, the widget below it is not highlighted. */
inline void wr_gui_ignore_hover(void)
{
    wr_gui_ignores_hover(*ImGui::GetCurrentContext(), 0) = true;
}

inline bool wr_gui_item_disabled(void)
{
    return wr_gui_flags_of(ImGui::GetCurrentContext()->LastItemData, 0) & ImGuiItemFlags_Disabled;
}

/* A disabled widget is below the pointer. */
inline bool wr_gui_disabled_hovered(void)
{
    return wr_gui_hovers_disabled(*ImGui::GetCurrentContext(), 0);
}

/* An invisible button below widgets that are drawn after it; it is hovered also where they are. */
inline bool wr_gui_button_below(const char *name, ImVec2 size, bool *hovered)
{
#if IMGUI_VERSION_NUM >= 18970
    ImGui::SetNextItemAllowOverlap();
    const bool pressed = ImGui::InvisibleButton(name, size);
    *hovered = ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenOverlappedByItem);
#else
    const bool pressed = ImGui::InvisibleButton(name, size);
    *hovered = ImGui::IsItemHovered();
    ImGui::SetItemAllowOverlap();
#endif
    return pressed;
}

/* Give the keyboard to the next item. Since 1.90 ImGui searches only the focused window. */
inline void wr_gui_keyboard_here(void)
{
    ImGuiWindow *window = ImGui::GetCurrentWindow();
    if (ImGui::GetCurrentContext()->NavWindow != window) ImGui::FocusWindow(window);
    ImGui::SetKeyboardFocusHere();
}

/* Before the end of a window or group: space below the last item counts. 1.92 requires an item for it. */
inline void wr_gui_count_space(void)
{
#if IMGUI_VERSION_NUM >= 19200
    if (ImGui::GetCurrentWindow()->DC.IsSetPos) ImGui::Dummy(ImVec2(0, 0));
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
