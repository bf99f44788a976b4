#include "image/caption.h"

#include "base/error.h"
#include "base/memory.h"
#include "image/font_list.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <string.h>

struct WrLabel {
    FT_Library library;
    FT_Face face;
};

WrLabel *wr_label_new(int size, WrError *err)
{
    WrLabel *label = wr_alloc(1, sizeof *label);
    if (size < 4 || size > 200) {
        wr_fail(err, "labels of %d pixels: must be 4..200", size);
        goto fail;
    }
    if (FT_Init_FreeType(&label->library)) {
        label->library = NULL;
        wr_fail(err, "labels: FreeType cannot be initialised");
        goto fail;
    }
    char *file =
        wr_font_file((const char *const[]){ "Inter", "DejaVu Sans", "sans-serif", NULL }, 400);
    if (!file || FT_New_Face(label->library, file, 0, &label->face)) label->face = NULL;
    wr_free(file);
    if (!label->face || FT_Set_Pixel_Sizes(label->face, 0, (FT_UInt)size)) {
        wr_fail(err, "labels: no typeface found: install the package fonts-inter");
        goto fail;
    }
    return label;
fail:
    wr_label_free(label);
    return NULL;
}

void wr_label_free(WrLabel *label)
{
    if (!label) return;
    if (label->face) FT_Done_Face(label->face);
    if (label->library) FT_Done_FreeType(label->library);
    wr_free(label);
}

/* The next character; invalid UTF-8 yields '?' for each byte. */
static uint32_t next_character(const char **text)
{
    const uint8_t *p = (const uint8_t *)*text;
    int more = p[0] < 0x80 ? 0 : p[0] < 0xc2 ? -1 : p[0] < 0xe0 ? 1 : p[0] < 0xf0 ? 2 : 3;
    uint32_t code = more > 0 ? p[0] & (0x3fu >> more) : p[0];
    if (p[0] >= 0xf5) more = -1;
    for (int i = 1; i <= more; i++) {
        if ((p[i] & 0xc0) != 0x80) more = -1;
        else code = code << 6 | (p[i] & 0x3fu);
    }
    *text += more > 0 ? 1 + more : 1;
    return more < 0 ? '?' : code;
}

static int advance(WrLabel *label, uint32_t character)
{
    if (FT_Load_Char(label->face, character, FT_LOAD_TARGET_LIGHT)) return 0;
    return (int)(label->face->glyph->advance.x + 32) >> 6;
}

int wr_label_width(WrLabel *label, const char *text)
{
    int width = 0;
    while (*text) width += advance(label, next_character(&text));
    return width;
}

static void draw_character(WrLabel *label, uint32_t character, int x, int y, uint8_t value,
                           uint8_t *pixels, int width, int height)
{
    if (FT_Load_Char(label->face, character, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT)) return;
    const FT_GlyphSlotRec *glyph = label->face->glyph;
    const FT_Bitmap *bits = &glyph->bitmap;
    if (bits->pixel_mode != FT_PIXEL_MODE_GRAY) return;
    for (int j = 0; j < (int)bits->rows; j++)
        for (int i = 0; i < (int)bits->width; i++) {
            int column = x + glyph->bitmap_left + i, row = y - glyph->bitmap_top + j;
            if (column < 0 || column >= width || row < 0 || row >= height) continue;
            uint8_t *pixel = &pixels[(size_t)row * (size_t)width + (size_t)column];
            int cover = bits->buffer[(ptrdiff_t)j * bits->pitch + i];
            *pixel = (uint8_t)((*pixel * (255 - cover) + value * cover + 127) / 255);
        }
}

void wr_label_draw(WrLabel *label, const char *text, int x, int y, int room, uint8_t value,
                   uint8_t *pixels, int width, int height)
{
    const int dots = 3 * advance(label, '.');
    const bool cut = wr_label_width(label, text) > room;
    int pen = 0;
    while (*text) {
        uint32_t character = next_character(&text);
        int step = advance(label, character);
        if (cut && pen + step + dots > room) break;
        draw_character(label, character, x + pen, y, value, pixels, width, height);
        pen += step;
    }
    for (int i = 0; cut && i < 3; i++, pen += dots / 3)
        draw_character(label, '.', x + pen, y, value, pixels, width, height);
}
