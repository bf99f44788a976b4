/* Serialisation of a shaped text as one block, and checks of an untrusted block. */
#include "image/font_internal.h"

#include "base/text.h"

#include <string.h>

#define COORDINATE_MAX (1 << 23) /* half units */
#define DOTS_MAX 4096            /* side of a bitmap glyph in dots */
#define PLACED_MAX (1 << 22)

void wr_font_making_fini(WrFontMaking *making)
{
    wr_array_free(&making->lines);
    wr_array_free(&making->placed);
    wr_array_free(&making->glyphs);
    wr_array_free(&making->points);
    wr_array_free(&making->missing);
    wr_array_free(&making->verbs);
    wr_array_free(&making->bytes);
}

void wr_font_text_fini(WrFontText *text)
{
    wr_free(text->block);
    *text = (WrFontText){ 0 };
}

/* ---- packing ---- */

static void add(WrText *out, const void *data, int count, size_t size)
{
    if (count > 0) wr_text_add_n(out, data, (size_t)count * size);
}

void wr_font_pack(const WrFontMaking *making, WrText *out)
{
    WrFontHead head = making->head;
    head.lines = making->lines.count;
    head.placed = making->placed.count;
    head.glyphs = making->glyphs.count;
    head.points = making->points.count;
    head.missing = making->missing.count;
    head.verbs = making->verbs.count;
    head.bytes = making->bytes.count;
    add(out, &head, 1, sizeof head);
    add(out, making->lines.data, head.lines, sizeof *making->lines.data);
    add(out, making->placed.data, head.placed, sizeof *making->placed.data);
    add(out, making->glyphs.data, head.glyphs, sizeof *making->glyphs.data);
    add(out, making->points.data, head.points, sizeof *making->points.data);
    add(out, making->missing.data, head.missing, sizeof *making->missing.data);
    add(out, making->verbs.data, head.verbs, 1);
    add(out, making->bytes.data, head.bytes, 1);
}

/* ---- checking ---- */

static bool within(int32_t x, int32_t most)
{
    return x >= -most && x <= most;
}

/* True if `count` items from `first` lie within `all`. */
static bool part_of(int32_t first, int32_t count, int32_t all)
{
    return first >= 0 && count >= 0 && first <= all && count <= all - first;
}

static bool check_head(const WrFontHead *h)
{
    return (h->bitmap == 0 || h->bitmap == 1) && h->units >= 1 && h->units <= 16384 &&
           within(h->ascent, 1 << 17) && within(h->descent, 1 << 17) && within(h->line, 1 << 18) &&
           h->lines >= 1 && h->lines <= WR_FONT_TEXT_MAX + 1 && h->placed >= 0 &&
           h->placed <= PLACED_MAX && h->glyphs >= 0 && h->glyphs <= 65536 * 2 && h->points >= 0 &&
           h->points <= WR_FONT_POINTS_MAX && h->missing >= 0 &&
           h->missing <= WR_FONT_MISSING_MAX && h->verbs >= 0 && h->verbs <= WR_FONT_POINTS_MAX &&
           h->bytes >= 0 && h->bytes <= WR_FONT_FILE_MAX;
}

static size_t block_size(const WrFontHead *h)
{
    return sizeof *h + (size_t)h->lines * sizeof(WrFontLine) +
           (size_t)h->placed * sizeof(WrFontPlaced) + (size_t)h->glyphs * sizeof(WrFontGlyph) +
           (size_t)h->points * sizeof(WrFontPoint) + (size_t)h->missing * sizeof(uint32_t) +
           (size_t)h->verbs + (size_t)h->bytes;
}

/* The verbs must begin with a move and use exactly the glyph's points. */
static bool check_verbs(const WrFontText *text, const WrFontGlyph *g)
{
    static const int32_t takes[] = { 1, 1, 2, 3 };
    int64_t points = 0;
    for (int32_t i = 0; i < g->verb_count; i++) {
        uint8_t verb = text->verbs[g->first_verb + i];
        if (verb > WR_FONT_CUBIC || (i == 0 && verb != WR_FONT_MOVE)) return false;
        points += takes[verb];
    }
    return points == g->point_count;
}

static bool check_glyph(const WrFontText *text, const WrFontGlyph *g)
{
    if (!part_of(g->first_verb, g->verb_count, text->verb_count) ||
        !part_of(g->first_point, g->point_count, text->point_count) || !check_verbs(text, g))
        return false;
    if (g->units < 1 || g->units > 16384 || g->font < 0 || g->font >= WR_FONT_FILES) return false;
    if (!within(g->left, 1 << 16) || !within(g->top, 1 << 16) || g->width < 0 || g->height < 0 ||
        g->width > DOTS_MAX || g->height > DOTS_MAX)
        return false;
    return part_of(g->first_byte, (g->width + 7) / 8 * g->height, text->byte_count);
}

static bool check_placed(const WrFontText *text, const WrFontPlaced *p, size_t text_length)
{
    return p->glyph >= 0 && p->glyph < text->glyph_count && within(p->advance, 1 << 18) &&
           within(p->dx, 1 << 18) && within(p->dy, 1 << 18) && p->cluster >= 0 &&
           (size_t)p->cluster <= text_length && (p->spaced == 0 || p->spaced == 1);
}

static bool check_parts(const WrFontText *text, size_t text_length)
{
    int32_t next = 0;
    for (int32_t i = 0; i < text->line_count; i++) {
        const WrFontLine *line = &text->lines[i];
        if (line->first != next || !part_of(line->first, line->count, text->placed_count) ||
            (line->leftwards != 0 && line->leftwards != 1))
            return false;
        next += line->count;
    }
    if (next != text->placed_count) return false;
    for (int32_t i = 0; i < text->placed_count; i++)
        if (!check_placed(text, &text->placed[i], text_length)) return false;
    for (int32_t i = 0; i < text->glyph_count; i++)
        if (!check_glyph(text, &text->glyphs[i])) return false;
    for (int32_t i = 0; i < text->point_count; i++)
        if (!within(text->points[i].x, COORDINATE_MAX) ||
            !within(text->points[i].y, COORDINATE_MAX))
            return false;
    for (int32_t i = 0; i < text->missing_count; i++)
        if (text->missing[i] > 0x10ffff) return false;
    return true;
}

bool wr_font_unpack(char *block, size_t length, size_t text_length, WrFontText *out)
{
    WrFontHead h;
    if (length < sizeof h) return false;
    memcpy(&h, block, sizeof h);
    if (!check_head(&h) || block_size(&h) != length) return false;
    WrFontText text = { .bitmap = h.bitmap != 0,
                        .units = h.units,
                        .ascent = h.ascent,
                        .descent = h.descent,
                        .line = h.line,
                        .line_count = h.lines,
                        .placed_count = h.placed,
                        .glyph_count = h.glyphs,
                        .verb_count = h.verbs,
                        .point_count = h.points,
                        .byte_count = h.bytes,
                        .missing_count = h.missing };
    text.lines = (const void *)(block + sizeof h);
    text.placed = (const void *)(text.lines + h.lines);
    text.glyphs = (const void *)(text.placed + h.placed);
    text.points = (const void *)(text.glyphs + h.glyphs);
    text.missing = (const void *)(text.points + h.points);
    text.verbs = (const void *)(text.missing + h.missing);
    text.bytes = text.verbs + h.verbs;
    if (!check_parts(&text, text_length)) return false;
    text.block = block;
    *out = text;
    return true;
}
