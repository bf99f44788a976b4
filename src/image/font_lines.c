/* Splits a text into lines, and lines into parts by direction (Unicode's bidirectional algorithm, by FriBidi).
   libraqm would do this and shape too, but through FreeType's scaled font; here HarfBuzz shapes in font units
   (font_free.c), and fonts without a shaper use the same parts. */
#include "image/font_internal.h"

#include "base/error.h"

#include <fribidi.h>
#include <string.h>

uint32_t wr_font_character(const char *text, size_t length, size_t *at)
{
    const uint8_t *p = (const uint8_t *)text + *at;
    size_t left = length - *at;
    uint32_t first = p[0], code = first;
    size_t more = first < 0x80 ? 0 : first < 0xc2 ? 9 : first < 0xe0 ? 1 : first < 0xf0 ? 2 : 3;
    bool good = more <= 3 && more < left && first < 0xf5;
    if (good && more > 0) code = first & (0x3fU >> more);
    for (size_t i = 1; good && i <= more; i++) {
        good = (p[i] & 0xc0) == 0x80;
        code = code << 6 | (p[i] & 0x3fU);
    }
    static const uint32_t least[] = { 0, 0x80, 0x800, 0x10000 };
    good = good && code >= least[more] && code <= 0x10ffff && !(code >= 0xd800 && code < 0xe000);
    *at += good ? 1 + more : 1;
    return good ? code : 0xfffd;
}

int wr_font_strange_bytes(const char *text)
{
    size_t length = strlen(text);
    int count = 0;
    for (size_t at = 0; at < length;) {
        size_t before = at;
        count += wr_font_character(text, length, &at) == 0xfffd && at == before + 1;
    }
    return count;
}

void wr_font_add_missing(WrFontMaking *making, uint32_t character)
{
    for (int i = 0; i < making->missing.count; i++)
        if (making->missing.data[i] == character) return;
    if (making->missing.count < WR_FONT_MISSING_MAX) wr_array_push(&making->missing, character);
}

/* ---- directions ---- */

typedef struct Level {
    WrFontRun run;
    int level;
} Level;

typedef struct Lines {
    WrFontMaking *making;
    WrFontLineMake make;
    void *ctx;
    WrFontChars chars;
    FriBidiCharType *types;
    FriBidiBracketType *brackets;
    FriBidiLevel *levels;
    WR_ARRAY(Level) parts;
    WR_ARRAY(WrFontRun) runs;
    WrFontDirection direction;
} Lines;

/* Rule L2: from the highest level down to the lowest odd one, reverses every sequence at that level or
 * higher. */
static void put_in_visual_order(Level *parts, int count, int highest)
{
    for (int level = highest; level >= 1; level--)
        for (int i = 0; i < count;) {
            int end = i;
            while (end < count && parts[end].level >= level) end++;
            for (int a = i, b = end - 1; a < b; a++, b--) {
                Level swap = parts[a];
                parts[a] = parts[b];
                parts[b] = swap;
            }
            i = end > i ? end : i + 1;
        }
}

/* The line's parts from left to right. False when out of memory. */
static bool find_runs(Lines *lines, bool *leftwards)
{
    int count = lines->chars.count, highest = 0;
    FriBidiParType base = lines->direction == WR_FONT_LEFT_TO_RIGHT   ? FRIBIDI_PAR_LTR
                          : lines->direction == WR_FONT_RIGHT_TO_LEFT ? FRIBIDI_PAR_RTL
                                                                      : FRIBIDI_PAR_ON;
    lines->parts.count = lines->runs.count = 0;
    *leftwards = base == FRIBIDI_PAR_RTL;
    if (count == 0) return true;
    fribidi_get_bidi_types(lines->chars.code, count, lines->types);
    fribidi_get_bracket_types(lines->chars.code, count, lines->types, lines->brackets);
    if (!fribidi_get_par_embedding_levels_ex(lines->types, lines->brackets, count, &base,
                                             lines->levels))
        return false;
    *leftwards = FRIBIDI_IS_RTL(base);
    for (int i = 0; i < count; i++) {
        int level = lines->levels[i];
        highest = level > highest ? level : highest;
        if (i == 0 || level != lines->parts.data[lines->parts.count - 1].level)
            wr_array_push(&lines->parts, ((Level){ { i, 0, (level & 1) != 0 }, level }));
        lines->parts.data[lines->parts.count - 1].run.count++;
    }
    put_in_visual_order(lines->parts.data, lines->parts.count, highest);
    for (int i = 0; i < lines->parts.count; i++)
        wr_array_push(&lines->runs, lines->parts.data[i].run);
    return true;
}

/* ---- lines ---- */

static bool make_line(Lines *lines, WrError *err)
{
    bool leftwards;
    int first = lines->making->placed.count;
    if (!find_runs(lines, &leftwards)) return wr_fail(err, "no memory to order a line's letters");
    if (!lines->make(lines->ctx, &lines->chars, lines->runs.data, lines->runs.count, err))
        return false;
    wr_array_push(&lines->making->lines,
                  ((WrFontLine){ first, lines->making->placed.count - first, leftwards }));
    return true;
}

static void free_lines(Lines *lines)
{
    wr_free(lines->chars.code);
    wr_free(lines->chars.byte);
    wr_free(lines->types);
    wr_free(lines->brackets);
    wr_free(lines->levels);
    wr_array_free(&lines->parts);
    wr_array_free(&lines->runs);
}

bool wr_font_lines(WrFontMaking *making, const WrFontRequest *ask, WrFontLineMake make, void *ctx,
                   WrError *err)
{
    size_t length = strlen(ask->text), at = 0;
    Lines lines = { .making = making, .make = make, .ctx = ctx, .direction = ask->direction };
    lines.chars.code = wr_alloc(length + 1, sizeof *lines.chars.code);
    lines.chars.byte = wr_alloc(length + 1, sizeof *lines.chars.byte);
    lines.types = wr_alloc(length + 1, sizeof *lines.types);
    lines.brackets = wr_alloc(length + 1, sizeof *lines.brackets);
    lines.levels = wr_alloc(length + 1, sizeof *lines.levels);
    bool good = true;
    while (good && at < length) {
        int32_t byte = (int32_t)at;
        uint32_t code = wr_font_character(ask->text, length, &at);
        if (code == '\n') {
            good = make_line(&lines, err);
            lines.chars.count = 0;
            continue;
        }
        if (code == '\t') code = ' ';
        if (code < 0x20 || code == 0x7f) continue;
        lines.chars.code[lines.chars.count] = code;
        lines.chars.byte[lines.chars.count++] = byte;
    }
    good = good && make_line(&lines, err);
    free_lines(&lines);
    return good;
}

/* ---- without shaping ---- */

void wr_font_shape_plain(WrFontFace *face, const WrFontChars *chars, int from, int count,
                         bool leftwards, WrFontMap map)
{
    for (int k = 0; k < count; k++) {
        int i = from + (leftwards ? count - 1 - k : k);
        uint32_t code = chars->code[i];
        FriBidiChar mirrored;
        int32_t advance = 0;
        if (leftwards && fribidi_get_mirror_char(code, &mirrored)) code = mirrored;
        int32_t glyph = map(face, code, &advance);
        wr_array_push(&face->making->placed,
                      ((WrFontPlaced){ glyph, advance, 0, 0, chars->byte[i], 1 }));
    }
}
