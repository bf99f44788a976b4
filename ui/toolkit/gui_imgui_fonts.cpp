/* Fonts and letter spacing: Inter if installed, else a fallback; icons from Material Design. */
#include "ui/toolkit/gui_imgui.h"
#include "ui/toolkit/gui_sdl_renderer.h"

#include <string.h>

/* ---- icons missing in the icon font, drawn on a grid of 24 units ---- */

/* Transformation from the grid to the window. */
struct Sheet {
    ImDrawList *list;
    ImVec2 at;
    float unit;
    ImU32 ink;
};

static ImVec2 on(const Sheet &sheet, float x, float y)
{
    return ImVec2(sheet.at.x + x * sheet.unit, sheet.at.y + y * sheet.unit);
}

static void box(const Sheet &sheet, float x0, float y0, float x1, float y1, float round)
{
    sheet.list->AddRectFilled(on(sheet, x0, y0), on(sheet, x1, y1), sheet.ink, round * sheet.unit);
}

/* A rubber stamp: knob, neck, foot, and the printed line. */
static void stamp(const Sheet &sheet)
{
    sheet.list->AddCircleFilled(on(sheet, 12, 5.6f), 3.4f * sheet.unit, sheet.ink, 24);
    sheet.list->AddQuadFilled(on(sheet, 10.6f, 7), on(sheet, 13.4f, 7), on(sheet, 14.6f, 14),
                              on(sheet, 9.4f, 14), sheet.ink);
    box(sheet, 4, 13.2f, 20, 17.8f, 1.4f);
    box(sheet, 4, 19.6f, 20, 21.4f, 0);
}

/* One half, the axis, and the mirrored half. */
static void mirror(const Sheet &sheet)
{
    for (int i = 0; i < 4; i++) {
        const float y = 2.2f + 5.4f * (float)i;
        box(sheet, 11.2f, y, 12.8f, y + 3.4f, 0);
    }
    sheet.list->AddTriangleFilled(on(sheet, 9.4f, 5), on(sheet, 9.4f, 19), on(sheet, 2, 19),
                                  sheet.ink);
    sheet.list->AddTriangle(on(sheet, 14.9f, 6.8f), on(sheet, 14.9f, 18.3f),
                            on(sheet, 20.9f, 18.3f), sheet.ink, 1.5f * sheet.unit);
}

bool wr_gui_draw_icon(ImDrawList *list, const char *icon, ImVec2 at, float side, ImU32 ink)
{
    const Sheet sheet = { list, at, side / 24, ink };
    if (strcmp(icon, WR_ICON_STAMP) == 0) stamp(sheet);
    else if (strcmp(icon, WR_ICON_MIRROR) == 0) mirror(sheet);
    else return false;
    return true;
}

/* ---- gui imgui fonts ---- */

extern "C" {
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/font_list.h"
#include "ui/toolkit/theme.h"
}

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_ADVANCES_H
#include <imgui_freetype.h>

#include <math.h>
/* font sizes in units: text, bold, small */
static const float face_ems[] = { 14.0f, 14.0f, 12.0f };

/* families of the window's text, in order of preference, and of its icons */
static const char *const text_families[] = { "Inter",           "DejaVu Sans", "Noto Sans",
                                             "Liberation Sans", "sans-serif",  nullptr };
static const char *const icon_families[] = { "Material Design Icons", nullptr };

/* A font file and its metrics as designed. */
struct Face {
    char *bytes; /* owned; NULL: ImGui's built-in font */
    size_t length;
    FT_Face info;
    /* line height, from the highest ascender to the lowest descender, in units of `scale` */
    float units;
    float scale; /* pixels per unit */
};

static bool open_face(FT_Library library, Face *face, const char *path, float em)
{
    if (!path || !wr_file_read(path, 32u << 20, &face->bytes, &face->length, nullptr)) return false;
    const auto *data = reinterpret_cast<const unsigned char *>(face->bytes);
    const bool opened =
        FT_New_Memory_Face(library, data, (FT_Long)face->length, 0, &face->info) == 0;
    if (!opened || !FT_IS_SCALABLE(face->info)) {
        if (opened) FT_Done_Face(face->info);
        wr_free(face->bytes);
        face->bytes = nullptr;
        return false;
    }
    face->scale = em / (float)face->info->units_per_EM;
    face->units = (float)(face->info->ascender - face->info->descender);
    return true;
}

/* Restore the designed advances (ImGui rounds each up, which spreads words), and give all digits the same width, so
   that changing numbers do not jitter. */
static void space_letters(ImFont *font, const Face *face)
{
    float digit = 0.0f;
    for (int pass = 0; pass < 2; pass++) {
        for (ImFontGlyph &glyph : wr_gui_glyphs(font)) {
            FT_Fixed units;
            const FT_UInt index = FT_Get_Char_Index(face->info, glyph.Codepoint);
            bool number = glyph.Codepoint >= '0' && glyph.Codepoint <= '9';
            if (index == 0) continue; /* an icon */
            if (FT_Get_Advance(face->info, index, FT_LOAD_NO_SCALE, &units) != 0) continue;
            float advance = (float)units * face->scale;
            if (pass == 0) {
                if (number && glyph.Codepoint != '1' && advance > digit) digit = advance;
                continue;
            }
            if (number) {
                float shift = roundf((digit - advance) / 2.0f);
                glyph.X0 += shift;
                glyph.X1 += shift;
                advance = digit;
            }
            glyph.AdvanceX = advance;
        }
    }
    wr_gui_glyphs_changed(font);
}

/* Convert the em size to the line height, which ImGui expects. */
static ImFont *add_face(ImFontAtlas *atlas, const Face *face)
{
    static const ImWchar ranges[] = { 0x20,   0x17f,  0x370,  0x3ff,  0x400,  0x45f, 0x2010,
                                      0x2027, 0x2190, 0x2193, 0x2212, 0x2212, 0 };
    ImFontConfig config;
    config.OversampleH = config.OversampleV = 1;
    config.FontDataOwnedByAtlas = false; /* ImGui makes a copy */
    return atlas->AddFontFromMemoryTTF(face->bytes, (int)face->length,
                                       roundf(face->units * face->scale), &config, ranges);
}

static void add_icons(ImFontAtlas *atlas, const char *path, float size, bool merge)
{
    static const ImWchar used[] = {
        0xf0e3, 0xf0e3, 0xf041, 0xf041, 0xf349, 0xf349, 0xf20a, 0xf20a, 0xf40a, 0xf40a, 0xf3e4,
        0xf3e4, 0xf140, 0xf140, 0xf142, 0xf142, 0xf35d, 0xf35d, 0xf156, 0xf156, 0xf415, 0xf415,
        0xf1c0, 0xf1c0, 0xf2d7, 0xf2d7, 0xf026, 0xf026, 0xf068, 0xf068, 0xf24b, 0xf24b, 0xf224,
        0xf224, 0xf05d, 0xf05d, 0xf12c, 0xf12c, 0xf464, 0xf464, 0xf208, 0xf209, 0xf339, 0xf339,
        0xf33e, 0xf340, 0xf191, 0xf191, 0xf0f8, 0xf0f8, 0xf045, 0xf045, 0xf489, 0xf489, 0xf556,
        0xf556, 0xf562, 0xf562, 0xf1d9, 0xf1d9, 0xf4ce, 0xf4ce, 0xf4d2, 0xf4d2, 0xf58c, 0xf58c,
        0xf2c7, 0xf2c7, 0xf18f, 0xf18f, 0xf130, 0xf131, 0xf560, 0xf560, 0xf5c6, 0xf5c6, 0xf559,
        0xf559, 0xf266, 0xf266, 0xf0b6, 0xf0b6, 0xf62e, 0xf62e, 0xf193, 0xf193, 0xf465, 0xf465,
        0xf1d8, 0xf1d8, 0xf1ce, 0xf1ce, 0xf573, 0xf573, 0xf1fe, 0xf1fe, 0xf5f4, 0xf5f4, 0xf1a6,
        0xf1a6, 0
    };
    ImFontConfig config;
    config.OversampleH = config.OversampleV = 1;
    config.PixelSnapH = true;
    config.MergeMode = merge;
    if (merge) config.GlyphOffset.y = roundf(size * 0.06f);
    atlas->AddFontFromFileTTF(path, size, &config, used);
}

static bool opens(FT_Library library, const char *path)
{
    FT_Face face;
    if (!path || FT_New_Face(library, path, 0, &face) != 0) return false;
    FT_Done_Face(face);
    return true;
}

/* Files of an earlier start are used while they open: Fontconfig needs longer than the rest of the start. */
static void find_files(FT_Library library, char **files)
{
    bool all = true;
    for (int i = 0; i < WR_GUI_FONT_FILES; i++) all = all && opens(library, files[i]);
    if (!all) wr_gui_find_fonts(files);
}

extern "C" void wr_gui_find_fonts(char **files)
{
    for (int i = 0; i < WR_GUI_FONT_FILES; i++) wr_free(files[i]);
    files[0] = wr_font_file(text_families, 400);
    files[1] = wr_font_file(text_families, 600);
    files[2] = wr_font_file(icon_families, 400);
}

static void add_fonts(WrGui *gui, ImFontAtlas *atlas, FT_Library library, Face faces[WR_FONT_ICON])
{
    find_files(library, gui->font_files);
    const char *text = gui->font_files[0], *bold = gui->font_files[1], *icons = gui->font_files[2];
    gui->no_text = !text;
    gui->no_icons = !icons;
    for (int i = 0; i < WR_FONT_ICON; i++) {
        float em = roundf(face_ems[i] * (float)gui->scale);
        bool found = open_face(library, &faces[i], i == WR_FONT_BOLD && bold ? bold : text, em);
        gui->fonts[i] = found ? add_face(atlas, &faces[i]) : atlas->AddFontDefault();
        if (found && icons) add_icons(atlas, icons, roundf(em * 1.35f), true);
    }
    gui->fonts[WR_FONT_ICON] = gui->fonts[WR_FONT_TEXT];
    int before = atlas->Fonts.Size;
    if (icons) add_icons(atlas, icons, roundf(22.0f * (float)gui->scale), false);
    if (atlas->Fonts.Size > before) gui->fonts[WR_FONT_ICON] = atlas->Fonts.back();
}

const char *wr_gui_icon(const char *icon)
{
    return wr_gui_current()->no_icons ? wr_icon_word(icon) : icon;
}

extern "C" const char *wr_gui_missing_fonts(const WrGui *gui)
{
    if (gui->no_icons && gui->no_text)
        return "no fonts were found: install fonts-inter and fonts-materialdesignicons-webfont";
    if (gui->no_icons)
        return "the font of the icons is missing, words stand in for them: install "
               "fonts-materialdesignicons-webfont";
    return gui->no_text ? "no font for text was found: install fonts-inter" : nullptr;
}

bool wr_gui_build_fonts(WrGui *gui, WrError *err)
{
    ImFontAtlas *atlas = ImGui::GetIO().Fonts;
    Face faces[WR_FONT_ICON] = {};
    FT_Library library;
    if (FT_Init_FreeType(&library) != 0) return wr_fail(err, "no font could be loaded");
    atlas->Clear();
    wr_gui_light_hinting(atlas);
    atlas->TexGlyphPadding = 1;
    add_fonts(gui, atlas, library, faces);
    unsigned char *pixels;
    int width, height;
    atlas->GetTexDataAsRGBA32(&pixels, &width, &height);
    for (int i = 0; i < WR_FONT_ICON; i++)
        if (faces[i].bytes) space_letters(gui->fonts[i], &faces[i]);
    FT_Done_FreeType(library); /* and the faces */
    for (Face &face : faces) wr_free(face.bytes);
    if (!pixels) return wr_fail(err, "no font could be loaded");
    if (gui->atlas) SDL_DestroyTexture(gui->atlas);
    gui->atlas = wr_gui_sdl_texture(gui->renderer, width, height, pixels);
    if (!gui->atlas) return wr_fail(err, "a texture of %dx%d: %s", width, height, SDL_GetError());
    atlas->ClearTexData();
    atlas->SetTexID(wr_gui_texture_id(gui->atlas));
    wr_gui_fonts_built(atlas);
    return true;
}
