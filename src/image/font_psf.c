/* PSF, the console's font format, versions 1 and 2: a header, dots of glyphs of equal size, and
   optionally a table of the characters of each glyph. */
#include "image/font_internal.h"

#include "base/error.h"

#include <string.h>

#define MODE_512 1 /* version 1: 512 glyphs, not 256 */
#define MODE_TABLE 6
#define FLAG_TABLE 1 /* version 2 */
#define GLYPHS_MAX 65536
#define SIDE_MAX 256 /* dots */
#define CHARACTERS 0x110000

typedef struct Psf {
    WrFontFace *face;
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

/* Sequences of characters, which begin after a mark, are skipped: they do not apply to single
 * characters. */
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
        /* the first glyph of a character wins */
        else if (!sequence && psf->of[code] == 0) psf->of[code] = glyph + 1;
    }
}

/* ---- glyphs ---- */

static int find(const Psf *psf, uint32_t character)
{
    if (!psf->table) return character < (uint32_t)psf->count ? (int)character : -1;
    return psf->of[character] - 1;
}

/* Adds a glyph to those of the text; size bytes of dots follow. Returns its index. */
static int32_t add_glyph(Psf *psf, int id)
{
    WrFontMaking *m = psf->face->making;
    WrFontGlyph g = { .id = (uint32_t)id,
                      .font = psf->face->font,
                      .units = psf->height,
                      .top = psf->height - psf->face->head.descent,
                      .width = psf->width,
                      .height = psf->height,
                      .first_byte = m->bytes.count };
    wr_array_push(&m->glyphs, g);
    psf->face->known.data[id] = m->glyphs.count;
    return m->glyphs.count - 1;
}

static int32_t take(Psf *psf, int glyph)
{
    if (psf->face->known.data[glyph]) return psf->face->known.data[glyph] - 1;
    int32_t place = add_glyph(psf, glyph);
    for (int i = 0; i < psf->size; i++)
        wr_array_push(&psf->face->making->bytes,
                      psf->dots[(size_t)glyph * (size_t)psf->size + (size_t)i]);
    return place;
}

/* A glyph for characters that the font lacks: a frame one dot wide, one dot smaller than a glyph on
 * each side, or empty. */
static int32_t take_own(Psf *psf, bool frame)
{
    int own = psf->count + frame;
    if (psf->face->known.data[own]) return psf->face->known.data[own] - 1;
    int32_t place = add_glyph(psf, own);
    int pitch = (psf->width + 7) / 8, right = psf->width - 2, low = psf->height - 2;
    for (int y = 0; y < psf->height; y++)
        for (int b = 0; b < pitch; b++) {
            unsigned byte = 0;
            for (int x = 8 * b; frame && x < 8 * b + 8; x++) {
                bool in = x >= 1 && x <= right && y >= 1 && y <= low;
                if (in && (x == 1 || x == right || y == 1 || y == low)) byte |= 0x80U >> (x & 7);
            }
            wr_array_push(&psf->face->making->bytes, (uint8_t)byte);
        }
    return place;
}

static bool is_space(uint32_t character)
{
    return character == ' ' || character == 0xa0;
}

static int32_t map(WrFontFace *face, uint32_t character, int32_t *advance)
{
    Psf *psf = face->ctx;
    int glyph = find(psf, character);
    *advance = psf->width;
    if (glyph >= 0) return take(psf, glyph);
    if (is_space(character)) return take_own(psf, false);
    wr_font_add_missing(face->making, character);
    return take_own(psf, true);
}

/* ---- the font ---- */

static bool has(const WrFontFace *face, uint32_t character)
{
    return find(face->ctx, character) >= 0 || is_space(character);
}

static bool shape(WrFontFace *face, const WrFontChars *chars, int from, int count, bool leftwards,
                  uint32_t script, WrError *err)
{
    (void)script;
    (void)err;
    wr_font_shape_plain(face, chars, from, count, leftwards, map);
    return true;
}

static void close(WrFontFace *face)
{
    Psf *psf = face->ctx;
    wr_array_free(&face->known);
    wr_free(psf->of);
    wr_free(psf);
}

bool wr_font_open_psf(WrFontFace *face, const uint8_t *bytes, size_t length, WrError *err)
{
    Psf read = { .face = face };
    if (!read_header(&read, bytes, length, err)) return false;
    Psf *psf = wr_alloc(1, sizeof *psf);
    *psf = read;
    if (psf->table) psf->of = wr_alloc(CHARACTERS, sizeof *psf->of);
    read_table(psf);
    wr_font_face_expect(face, psf->count + 2);
    int descent = psf->height / 5;
    face->head = (WrFontHead){ .bitmap = 1,
                               .units = psf->height,
                               .ascent = psf->height - descent,
                               .descent = descent,
                               .line = psf->height };
    face->ctx = psf;
    face->has = has;
    face->shape = shape;
    face->close = close;
    return true;
}
