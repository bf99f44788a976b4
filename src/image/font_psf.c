/* PSF, the console's fonts, of both versions: a header, dots of equally large glyphs, and perhaps a table
   that tells for each glyph the characters that it stands for. */
#include "image/font_inner.h"

#include <string.h>

#define MODE_512 1 /* version 1: 512 glyphs, not 256 */
#define MODE_TABLE 6
#define FLAG_TABLE 1 /* version 2 */
#define GLYPHS_MAX 65536
#define SIDE_MAX 256 /* dots */
#define CHARACTERS 0x110000

typedef struct Psf {
    WrFontMaking *making;
    const uint8_t *dots; /* [count][size] */
    const uint8_t *table, *end;
    int count, size, width, height;
    bool two;    /* version 2: the table is UTF-8, else UCS-2 */
    int32_t *of; /* [CHARACTERS] character -> glyph + 1; NULL without a table */
} Psf;

bool wr_psf_is(const uint8_t *bytes, size_t length)
{
    static const uint8_t one[] = { 0x36, 0x04 }, two[] = { 0x72, 0xb5, 0x4a, 0x86 };
    return (length >= 4 && memcmp(bytes, one, sizeof one) == 0) ||
           (length >= 32 && memcmp(bytes, two, sizeof two) == 0);
}

static uint32_t word_at(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

/* ---- the header ---- */

static bool read_header(Psf *psf, const uint8_t *bytes, size_t length, WrError *err)
{
    size_t start = 4, count = 256, size = bytes[3], width = 8, height = bytes[3];
    bool table = (bytes[2] & MODE_TABLE) != 0;
    psf->two = bytes[0] == 0x72;
    if (psf->two) {
        start = word_at(bytes + 8);
        table = (word_at(bytes + 12) & FLAG_TABLE) != 0;
        count = word_at(bytes + 16);
        size = word_at(bytes + 20);
        height = word_at(bytes + 24);
        width = word_at(bytes + 28);
    } else if (bytes[2] & MODE_512) {
        count = 512;
    }
    if (count < 1 || count > GLYPHS_MAX)
        return wr_fail(err, "PSF with %zu glyphs: must be 1..%d", count, GLYPHS_MAX);
    if (width < 1 || width > SIDE_MAX || height < 1 || height > SIDE_MAX)
        return wr_fail(err, "PSF with %zu x %zu dots: must be 1..%d each way", width, height,
                       SIDE_MAX);
    if (size != (width + 7) / 8 * height)
        return wr_fail(err, "PSF whose glyphs take %zu bytes: must be %zu for %zu x %zu dots", size,
                       (width + 7) / 8 * height, width, height);
    if (start > length || count * size > length - start)
        return wr_fail(err, "PSF that ends within its glyphs: the file is cut off");
    psf->dots = bytes + start;
    psf->count = (int)count;
    psf->size = (int)size;
    psf->width = (int)width;
    psf->height = (int)height;
    psf->end = bytes + length;
    psf->table = table ? psf->dots + count * size : NULL;
    return true;
}

/* ---- the table ---- */

/* Sequences of characters, which begin after a mark, are not for single characters and passed over. */
static void read_table(Psf *psf)
{
    int glyph = 0;
    bool sequence = false;
    size_t at = 0, length = psf->table ? (size_t)(psf->end - psf->table) : 0;
    while (at < length && glyph < psf->count) {
        uint32_t code;
        bool stop, mark;
        if (psf->two) {
            stop = psf->table[at] == 0xff;
            mark = psf->table[at] == 0xfe;
            code = psf->table[at];
            if (stop || mark) at++;
            else code = wr_font_character((const char *)psf->table, length, &at);
        } else {
            if (length - at < 2) return;
            code = (uint32_t)psf->table[at] | (uint32_t)psf->table[at + 1] << 8;
            at += 2;
            stop = code == 0xffff;
            mark = code == 0xfffe;
        }
        if (stop) glyph++, sequence = false;
        else if (mark) sequence = true;
        else if (!sequence && psf->of[code] == 0) psf->of[code] = glyph + 1; /* the first has it */
    }
}

/* ---- glyphs ---- */

static int find(const Psf *psf, uint32_t character)
{
    if (!psf->table) return character < (uint32_t)psf->count ? (int)character : -1;
    return psf->of[character] - 1;
}

/* A glyph's place among those of the text. */
static int32_t take(Psf *psf, int glyph)
{
    WrFontMaking *m = psf->making;
    if (m->known.data[glyph]) return m->known.data[glyph] - 1;
    WrFontGlyph g = { .id = (uint32_t)glyph,
                      .top = psf->height,
                      .width = psf->width,
                      .height = psf->height,
                      .first_byte = m->bytes.count };
    for (int i = 0; i < psf->size; i++)
        wr_array_push(&m->bytes, psf->dots[(size_t)glyph * (size_t)psf->size + (size_t)i]);
    wr_array_push(&m->glyphs, g);
    m->known.data[glyph] = m->glyphs.count;
    return m->glyphs.count - 1;
}

/* What no character of the font shows: a frame one dot wide, one dot smaller than a glyph on each side, or
 * nothing at all. */
static int32_t take_own(Psf *psf, bool frame)
{
    WrFontMaking *m = psf->making;
    int own = psf->count + frame;
    if (m->known.data[own]) return m->known.data[own] - 1;
    WrFontGlyph g = { .id = (uint32_t)own,
                      .top = psf->height,
                      .width = psf->width,
                      .height = psf->height,
                      .first_byte = m->bytes.count };
    int pitch = (psf->width + 7) / 8, right = psf->width - 2, low = psf->height - 2;
    for (int y = 0; y < psf->height; y++)
        for (int b = 0; b < pitch; b++) {
            unsigned byte = 0;
            for (int x = 8 * b; frame && x < 8 * b + 8; x++) {
                bool in = x >= 1 && x <= right && y >= 1 && y <= low;
                if (in && (x == 1 || x == right || y == 1 || y == low)) byte |= 0x80U >> (x & 7);
            }
            wr_array_push(&m->bytes, (uint8_t)byte);
        }
    wr_array_push(&m->glyphs, g);
    m->known.data[own] = m->glyphs.count;
    return m->glyphs.count - 1;
}

static int32_t map(void *ctx, uint32_t character, int32_t *advance)
{
    Psf *psf = ctx;
    int glyph = find(psf, character);
    *advance = psf->width;
    if (glyph >= 0) return take(psf, glyph);
    if (character == ' ' || character == 0xa0) return take_own(psf, false);
    wr_font_add_missing(psf->making, character);
    return take_own(psf, true);
}

bool wr_psf_make(const uint8_t *bytes, size_t length, const WrFontAsk *ask, WrFontMaking *out,
                 WrError *err)
{
    Psf psf = { .making = out };
    if (!read_header(&psf, bytes, length, err)) return false;
    if (psf.table) psf.of = wr_alloc(CHARACTERS, sizeof *psf.of);
    read_table(&psf);
    wr_array_reserve(&out->known, psf.count + 2);
    out->known.count = psf.count + 2;
    memset(out->known.data, 0, (size_t)out->known.count * sizeof *out->known.data);
    int descent = psf.height / 5;
    out->head = (WrFontHead){ .bitmap = 1,
                              .units = psf.height,
                              .ascent = psf.height - descent,
                              .descent = descent,
                              .line = psf.height };
    bool good = wr_font_lay_plain(out, ask, map, &psf, err);
    for (int i = 0; i < out->glyphs.count; i++) out->glyphs.data[i].top -= descent;
    wr_free(psf.of);
    return good;
}
