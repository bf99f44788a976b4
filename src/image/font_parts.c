/* Splits lines into parts of one direction, one script and one font. */
#include "base/error.h"
#include "base/memory.h"
#include "image/font_internal.h"

#include <hb.h>

typedef struct Parts {
    WrFontFace *faces;
    int count;
    WR_ARRAY(uint8_t) owner; /* font of each character of a line */
} Parts;

/* ---- choice of fonts ---- */

/* The first font that has all of code[first..end), or -1. */
static int font_of(const Parts *parts, const uint32_t *code, int first, int end)
{
    for (int f = 0; f < parts->count; f++) {
        int i = first;
        while (i < end && parts->faces[f].has(&parts->faces[f], code[i])) i++;
        if (i == end) return f;
    }
    return -1;
}

static bool is_mark(hb_unicode_general_category_t is)
{
    return is == HB_UNICODE_GENERAL_CATEGORY_NON_SPACING_MARK ||
           is == HB_UNICODE_GENERAL_CATEGORY_SPACING_MARK ||
           is == HB_UNICODE_GENERAL_CATEGORY_ENCLOSING_MARK;
}

/* Joiners and other invisible characters use the font of the preceding character; marks use that of
 * their base, if necessary in another font that has all of them. */
static void choose_fonts(Parts *parts, const WrFontChars *chars)
{
    hb_unicode_funcs_t *unicode = hb_unicode_funcs_get_default();
    int base = 0; /* base character of the marks */
    parts->owner.count = 0;
    for (int i = 0; i < chars->count; i++) {
        hb_unicode_general_category_t is = hb_unicode_general_category(unicode, chars->code[i]);
        int before = i > 0 ? parts->owner.data[i - 1] : -1, font;
        if (before >= 0 && is == HB_UNICODE_GENERAL_CATEGORY_FORMAT) {
            font = before;
        } else if (before >= 0 && is_mark(is)) {
            font = before;
            if (!parts->faces[before].has(&parts->faces[before], chars->code[i])) {
                int whole = font_of(parts, chars->code, base, i + 1);
                for (int k = base; k < i && whole >= 0; k++) parts->owner.data[k] = (uint8_t)whole;
                font = whole >= 0 ? whole : before;
            }
        } else {
            base = i;
            font = font_of(parts, chars->code, i, i + 1);
        }
        wr_array_push(&parts->owner, (uint8_t)(font < 0 ? 0 : font));
    }
}

/* ---- choice of scripts ---- */

static bool is_plain_script(hb_script_t script)
{
    return script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED ||
           script == HB_SCRIPT_UNKNOWN;
}

/* The first script from `i` on, or common. */
static hb_script_t script_from(const WrFontChars *chars, int i, int end)
{
    hb_unicode_funcs_t *unicode = hb_unicode_funcs_get_default();
    for (; i < end; i++) {
        hb_script_t script = hb_unicode_script(unicode, chars->code[i]);
        if (!is_plain_script(script)) return script;
    }
    return HB_SCRIPT_COMMON;
}

/* End of the part that begins at `i`: before the first character of another script. */
static int script_end(const WrFontChars *chars, int i, int end, hb_script_t script)
{
    hb_unicode_funcs_t *unicode = hb_unicode_funcs_get_default();
    for (; i < end; i++) {
        hb_script_t is = hb_unicode_script(unicode, chars->code[i]);
        if (!is_plain_script(is) && is != script) return i;
    }
    return end;
}

/* ---- parts ---- */

typedef struct Part {
    int from, count, font;
    hb_script_t script;
} Part;

/* The parts of a leftward run are ordered from right to left. */
static bool shape_run(Parts *parts, const WrFontChars *chars, const WrFontRun *run, WrError *err)
{
    WR_ARRAY(Part) list = { 0 };
    int end = run->first + run->count;
    bool good = true;
    for (int i = run->first; i < end;) {
        hb_script_t script = script_from(chars, i, end);
        int stop = script_end(chars, i, end, script);
        for (int from = i; from < stop; from = i) {
            int font = parts->owner.data[from];
            while (i < stop && parts->owner.data[i] == font) i++;
            wr_array_push(&list, ((Part){ from, i - from, font, script }));
        }
    }
    for (int k = 0; k < list.count && good; k++) {
        Part p = list.data[run->leftwards ? list.count - 1 - k : k];
        WrFontFace *face = &parts->faces[p.font];
        good = face->shape(face, chars, p.from, p.count, run->leftwards, p.script, err);
    }
    wr_array_free(&list);
    return good;
}

static bool shape_line(void *ctx, const WrFontChars *chars, const WrFontRun *runs, int run_count,
                       WrError *err)
{
    Parts *parts = ctx;
    choose_fonts(parts, chars);
    for (int i = 0; i < run_count; i++)
        if (!shape_run(parts, chars, &runs[i], err)) return false;
    return true;
}

bool wr_font_parts(WrFontFace *faces, int count, WrError *err)
{
    Parts parts = { .faces = faces, .count = count };
    bool good = wr_font_lines(faces[0].making, faces[0].ask, shape_line, &parts, err);
    wr_array_free(&parts.owner);
    return good;
}
