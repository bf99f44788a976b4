#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/tip_internal.h"

#include <math.h>
#include <string.h>

/* ---- smooth ---- */

/* Removal of quantization steps from 8-bit tips, and the smaller mip levels of a tip.

   A code represents any value within half a step of it. Of all pictures with these codes the smoothest
   is wanted: the limit of diffusion with each value kept within its half step. The flat parts of a
   gentle slope are wide, and diffusion is slow, so it starts on small pictures: the codes are halved by
   box means up to WR_SMOOTH_LEVELS times, and from the smallest up each picture is enlarged (bilinear),
   clamped to its bounds, and diffused a little ([1 2 1]/4 in both directions). If codes differ by over
   1.5 from one pixel to the next there is an edge or texture, not a quantization step: such pixels keep
   their code, and the smaller pictures have a hole (NaN) there, so that nothing spreads over an edge:
   black pixels beside one stay exactly black. */

#define WR_SMOOTH_LEVELS 8
#define WR_SMOOTH_MAX 24 /* maximum steps of diffusion for each level */
#define WR_SMOOTH_MIN 6
#define WR_SMOOTH_WORK (1 << 27) /* pixels times steps, above which fewer steps are used */
#define WR_SMOOTH_STAIR 1.5f     /* codes; larger differences are edges */

/* ---- sizes ---- */

/* The inputs covered by output i of out_n, of in_n in total, and the weights of the first and last one. */
typedef struct Span {
    int first, last;
    double head, tail, inverse; /* covered fractions of the first and last; 1/length */
} Span;

/* Output i covers inputs from i in_n / out_n to (i + 1) in_n / out_n: exact area weights for any ratio, also of odd sizes, so
   that the mean is preserved. */
static Span span_of(int i, int in_n, int out_n)
{
    /* In units of 1/out_n input, so that all ends are integers. */
    int64_t low = (int64_t)i * in_n, high = low + in_n;
    Span s = { .first = (int)(low / out_n), .last = (int)((high - 1) / out_n) };
    s.head = (double)((int64_t)(s.first + 1) * out_n - low) / out_n;
    s.tail = (double)(high - (int64_t)s.last * out_n) / out_n;
    s.inverse = (double)out_n / in_n;
    return s;
}

static double share(const Span *s, int k)
{
    return k == s->first ? s->head : k == s->last ? s->tail : 1.0;
}

/* One level from the next larger one: box means by area. */
static void tip_halve(const float *in, int in_w, int in_h, float *out, int out_w, int out_h)
{
    for (int j = 0; j < out_h; j++) {
        Span rows = span_of(j, in_h, out_h);
        for (int i = 0; i < out_w; i++) {
            Span columns = span_of(i, in_w, out_w);
            double sum = 0;
            for (int y = rows.first; y <= rows.last; y++)
                for (int x = columns.first; x <= columns.last; x++)
                    sum += share(&rows, y) * share(&columns, x) *
                           (double)in[(size_t)y * (size_t)in_w + (size_t)x];
            out[(size_t)j * (size_t)out_w + (size_t)i] =
                (float)(sum * rows.inverse * columns.inverse);
        }
    }
}

/* ---- smoothing ---- */

typedef struct Picture {
    float *values; /* [height][width] */
    int width, height;
} Picture;

static size_t at(const Picture *p, int i, int j)
{
    return (size_t)j * (size_t)p->width + (size_t)i;
}

/* The codes with holes at neighbours that differ by over a step. */
static void punch(const Picture *codes, Picture *out)
{
    for (int j = 0; j < codes->height; j++)
        for (int i = 0; i < codes->width; i++) {
            float c = codes->values[at(codes, i, j)];
            bool rough = false;
            for (int k = 0; k < 4 && !rough; k++) {
                int x = i + (k == 0) - (k == 1), y = j + (k == 2) - (k == 3);
                if (x < 0 || x >= codes->width || y < 0 || y >= codes->height) continue;
                rough = fabsf(codes->values[at(codes, x, y)] - c) > WR_SMOOTH_STAIR;
            }
            out->values[at(out, i, j)] = rough ? NAN : c;
        }
}

/* Half the size; a hole if any covered pixel is one, or if they differ by over a step. */
static void shrink(const Picture *in, Picture *out)
{
    tip_halve(in->values, in->width, in->height, out->values, out->width, out->height);
    for (int j = 0; j < out->height; j++)
        for (int i = 0; i < out->width; i++) {
            Span rows = span_of(j, in->height, out->height);
            Span columns = span_of(i, in->width, out->width);
            float low = INFINITY, high = -INFINITY;
            for (int y = rows.first; y <= rows.last; y++)
                for (int x = columns.first; x <= columns.last; x++) {
                    float v = in->values[at(in, x, y)];
                    low = v < low ? v : low;
                    high = v > high ? v : high;
                }
            if (high - low > WR_SMOOTH_STAIR) out->values[at(out, i, j)] = NAN;
        }
}

/* Position of an enlarged picture's pixel in the smaller one: taps first and next, weight of next. */
static void place(int i, int n, int small_n, int *first, int *next, float *part)
{
    double x = (i + 0.5) * small_n / n - 0.5, low = floor(x);
    *part = (float)(x - low);
    *first = low < 0 ? 0 : (int)low;
    *next = low + 1 < small_n ? (int)low + 1 : small_n - 1;
}

static float within(float x, float code)
{
    float low = code - 0.5f, high = code + 0.5f;
    low = low < 0.0f ? 0.0f : low;
    return x < low ? low : x > high ? high : x;
}

/* Initial values: the smaller picture, enlarged, if it has no hole; else the codes. */
static void enlarge(const Picture *small, const Picture *codes, Picture *out)
{
    for (int j = 0; j < out->height; j++) {
        int top, bottom;
        float fy;
        place(j, out->height, small->height, &top, &bottom, &fy);
        for (int i = 0; i < out->width; i++) {
            int left, right;
            float fx, code = codes->values[at(codes, i, j)];
            place(i, out->width, small->width, &left, &right, &fx);
            float a = small->values[at(small, left, top)];
            float b = small->values[at(small, right, top)];
            float c = small->values[at(small, left, bottom)];
            float d = small->values[at(small, right, bottom)];
            float upper = a + fx * (b - a), lower = c + fx * (d - c);
            float x = upper + fy * (lower - upper);
            out->values[at(out, i, j)] = isnan(x) || isnan(code) ? code : within(x, code);
        }
    }
}

/* One row of [1 2 1]/4 across; a hole is replaced by its neighbour. */
static void blur_row(const float *in, int width, float *out)
{
    for (int i = 0; i < width; i++) {
        float c = in[i], l = in[i > 0 ? i - 1 : 0], r = in[i < width - 1 ? i + 1 : i];
        l = isnan(l) ? c : l;
        r = isnan(r) ? c : r;
        out[i] = 0.25f * (l + r) + 0.5f * c;
    }
}

/* One step of diffusion in place; rows: [3][width] of memory. */
static void diffuse(Picture *p, const Picture *codes, float *rows)
{
    size_t width = (size_t)p->width;
    float *above = rows, *here = rows + width, *below = rows + 2 * width;
    blur_row(p->values, p->width, here);
    memcpy(above, here, width * sizeof *rows);
    for (int j = 0; j < p->height; j++) {
        if (j + 1 < p->height) blur_row(p->values + at(p, 0, j + 1), p->width, below);
        else memcpy(below, here, width * sizeof *rows);
        for (size_t i = 0; i < width; i++) {
            size_t k = at(p, 0, j) + i;
            float code = codes->values[k], c = here[i];
            float u = isnan(above[i]) ? c : above[i], d = isnan(below[i]) ? c : below[i];
            if (!isnan(code)) p->values[k] = within(0.25f * (u + d) + 0.5f * c, code);
        }
        float *spare = above;
        above = here;
        here = below;
        below = spare;
    }
}

static bool picture_new(Picture *p, int width, int height, WrError *err)
{
    *p = (Picture){ .width = width, .height = height };
    p->values = wr_try_alloc((size_t)width * (size_t)height, sizeof *p->values,
                             "smoothing a brush tip", err);
    return p->values;
}

/* Smooths values in units of codes; each changes by at most 1/2. */
static bool tip_smooth(float *values, int width, int height, WrError *err)
{
    Picture codes[WR_SMOOTH_LEVELS + 1] = { { .values = NULL } }, smooth = { .values = NULL };
    Picture given = { values, width, height };
    float *rows = wr_try_alloc((size_t)width * 3, sizeof *rows, "smoothing a brush tip", err);
    int last = 0, steps = WR_SMOOTH_WORK / (width * height);
    steps = steps < WR_SMOOTH_MIN ? WR_SMOOTH_MIN : steps;
    steps = steps > WR_SMOOTH_MAX ? WR_SMOOTH_MAX : steps;
    bool good = rows && picture_new(&codes[0], width, height, err);
    if (good) punch(&given, &codes[0]);
    while (good && last < WR_SMOOTH_LEVELS && (codes[last].width > 1 || codes[last].height > 1)) {
        int w = (codes[last].width + 1) / 2, h = (codes[last].height + 1) / 2;
        good = picture_new(&codes[last + 1], w, h, err);
        if (good) shrink(&codes[last], &codes[last + 1]);
        last += good;
    }
    for (int l = last; good && l >= 0; l--) {
        Picture next;
        good = picture_new(&next, codes[l].width, codes[l].height, err);
        if (!good) break;
        enlarge(l == last ? &codes[l] : &smooth, &codes[l], &next);
        wr_free(smooth.values);
        smooth = next;
        for (int k = 0; k < steps; k++) diffuse(&smooth, &codes[l], rows);
    }
    for (size_t k = 0; good && k < (size_t)width * (size_t)height; k++)
        if (!isnan(smooth.values[k])) values[k] = smooth.values[k];
    wr_free(smooth.values);
    for (int l = 0; l <= WR_SMOOTH_LEVELS; l++) wr_free(codes[l].values);
    wr_free(rows);
    return good;
}

/* ---- gbr ---- */

/* GIMP's .gbr: one picture. Big-endian numbers of 32 bits: length of the header, version, width,
   height, bytes per pixel (1: grey, 255 is full paint; 4: RGBA), in version 2 also "GIMP" and the
   spacing in per cent of the width; then the name and a NUL to the header's end, then the pixels, the
   top row first. */

#define WR_GBR_V1 20u      /* bytes before the name */
#define WR_GBR_V2 28u      /* bytes before the name in version 2 */
#define WR_GBR_NAME 65536u /* maximum bytes of a name */

static uint32_t big32(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/* True if it begins like a .gbr. */
static bool tip_is_gbr(const uint8_t *bytes, size_t size)
{
    if (size < WR_GBR_V1) return false;
    uint32_t version = big32(bytes + 4);
    if (size >= WR_GBR_V2 && memcmp(bytes + 20, "GIMP", 4) == 0) return true;
    return version == 1 && big32(bytes) >= WR_GBR_V1 && big32(bytes) < WR_GBR_V1 + WR_GBR_NAME;
}

/* The length of a valid UTF-8 sequence at p, 0 if none. */
static size_t utf8_length(const uint8_t *p, size_t size)
{
    static const uint32_t smallest[5] = { 0, 0, 0x80, 0x800, 0x10000 };
    size_t n = p[0] < 0x80 ? 1 : p[0] < 0xc0 ? 0 : p[0] < 0xe0 ? 2 : p[0] < 0xf0 ? 3 : 4;
    if (n == 0 || n > size || p[0] >= 0xf8) return 0;
    if (n == 1) return 1;
    uint32_t code = p[0] & (0x7fu >> n);
    for (size_t i = 1; i < n; i++) {
        if ((p[i] & 0xc0) != 0x80) return 0;
        code = code << 6 | (p[i] & 0x3fu);
    }
    bool good = code >= smallest[n] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
    return good ? n : 0;
}

/* Untrusted text made printable: control characters and invalid UTF-8 become '?'. The caller frees it. */
static char *tip_clean_name(const uint8_t *bytes, size_t size)
{
    char *name = wr_alloc(size + 1, 1);
    size_t length = 0;
    for (size_t i = 0; i < size && bytes[i];) {
        size_t n = utf8_length(bytes + i, size - i);
        bool shown = n > 1 || (n == 1 && bytes[i] >= 0x20 && bytes[i] != 0x7f);
        if (!shown) n = 1;
        for (size_t k = 0; k < n; k++) name[length++] = shown ? (char)bytes[i + k] : '?';
        i += n;
    }
    return name;
}

typedef struct Header {
    uint32_t length, version, width, height, bytes;
    uint32_t fixed; /* bytes before the name */
    double spacing;
} Header;

/* .gbr: big-endian uint32 header length, version, width, height, bytes per pixel; in version 2 then "GIMP" and the spacing in
   percent of the width; the name up to the header's end; pixels row by row from the top, grey or RGBA. */
static bool read_header(const uint8_t *bytes, size_t size, Header *header, const char *what,
                        WrError *err)
{
    if (size < WR_GBR_V1)
        return wr_fail(err, "%s: a .gbr brush of %zu bytes: must be more than its header of 20",
                       what, size);
    Header h = { big32(bytes),
                 big32(bytes + 4),
                 big32(bytes + 8),
                 big32(bytes + 12),
                 big32(bytes + 16),
                 WR_GBR_V1,
                 0.5 };
    if (h.version != 1 && h.version != 2)
        return wr_fail(err, "%s: a .gbr brush of version %u: must be 1 or 2", what, h.version);
    if (h.version == 2) {
        h.fixed = WR_GBR_V2;
        if (size < WR_GBR_V2 || memcmp(bytes + 20, "GIMP", 4) != 0)
            return wr_fail(err, "%s: not a .gbr brush: \"GIMP\" is missing at byte 20", what);
        uint32_t percent = big32(bytes + 24);
        h.spacing = (percent > 500 ? 500 : percent) * 0.02; /* of the width -> of the radius */
    }
    if (h.length < h.fixed || h.length - h.fixed > WR_GBR_NAME || h.length > size)
        return wr_fail(err, "%s: a .gbr header of %u bytes: must be %u..%zu", what, h.length,
                       h.fixed, size);
    if (h.bytes != 1 && h.bytes != 4)
        return wr_fail(err, "%s: a .gbr brush of %u bytes a pixel: must be 1 or 4", what, h.bytes);
    if (h.width < 1 || h.width > WR_TIP_SIDE || h.height < 1 || h.height > WR_TIP_SIDE)
        return wr_fail(err, "%s: a .gbr brush of %ux%u pixels: each side must be 1..%d", what,
                       h.width, h.height, WR_TIP_SIDE);
    size_t need = (size_t)h.width * h.height * h.bytes;
    if (need > size - h.length)
        return wr_fail(err, "%s: truncated: %ux%u pixels need %zu bytes, the file has %zu", what,
                       h.width, h.height, need, size - h.length);
    *header = h;
    return true;
}

/* In codes 0..255: grey unchanged, or Rec. 709 luma times alpha. */
static void read_pixels(const uint8_t *in, size_t count, uint32_t bytes, float *out)
{
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = in + i * bytes;
        if (bytes == 1) out[i] = p[0];
        else out[i] = (float)((0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) * (p[3] / 255.0));
    }
}

/* Parses one .gbr at the start of bytes into a cell; *used: its length. name (may be NULL) and spacing
 * are set if the file has them. */
static bool tip_parse_gbr(WrTip *tip, int cell, const uint8_t *bytes, size_t size, size_t *used,
                          char **name, double *spacing, const char *what, WrError *err)
{
    Header h = { 0 };
    if (!read_header(bytes, size, &h, what, err)) return false;
    if (!wr_tip_cell_alloc(tip, cell, (int)h.width, (int)h.height, what, err)) return false;
    size_t count = (size_t)h.width * h.height;
    read_pixels(bytes + h.length, count, h.bytes, tip->cell[cell].values);
    if (!wr_tip_cell_build_levels(tip, cell, 255, err)) return false;
    *used = h.length + count * h.bytes;
    if (name) *name = tip_clean_name(bytes + h.fixed, h.length - h.fixed);
    if (spacing) *spacing = h.spacing;
    return true;
}

/* ---- gih ---- */

/* GIMP's .gih: a line with the name, a line with the number of pictures and "name:value" words, then
   the pictures as consecutive .gbr files. Relevant words: dim (ranks), rank0.. (size of each), sel0..
   or selection (selection rule). The cells are ordered like the digits of a number, rank 0 first. */

#define WR_GIH_LINE 65536u /* maximum bytes of one line */

typedef struct Line {
    const uint8_t *text;
    size_t length;
} Line;

/* The next line without its end; false if there is none. */
static bool next_line(const uint8_t *bytes, size_t size, size_t *offset, Line *line)
{
    size_t left = size - *offset, limit = left < WR_GIH_LINE ? left : WR_GIH_LINE;
    const uint8_t *start = bytes + *offset;
    const uint8_t *end = limit > 0 ? memchr(start, '\n', limit) : NULL;
    if (!end) return false;
    *offset += (size_t)(end - start) + 1;
    line->text = start;
    line->length = (size_t)(end - start);
    if (line->length > 0 && start[line->length - 1] == '\r') line->length--;
    return true;
}

static bool next_word(Line *line, Line *word)
{
    while (line->length > 0 && (line->text[0] == ' ' || line->text[0] == '\t')) {
        line->text++;
        line->length--;
    }
    size_t n = 0;
    while (n < line->length && line->text[n] != ' ' && line->text[n] != '\t') n++;
    *word = (Line){ line->text, n };
    line->text += n;
    line->length -= n;
    return n > 0;
}

static bool whole_number(Line word, int *number)
{
    double x;
    if (!wr_number_parse((const char *)word.text, word.length, &x)) return false;
    if (!(x >= 0 && x <= 1e9) || x != (double)(int)x) return false;
    *number = (int)x;
    return true;
}

static bool is(Line word, const char *text)
{
    return word.length == strlen(text) && memcmp(word.text, text, word.length) == 0;
}

/* The digit of a word that consists of `name` and a digit, else -1. */
static int numbered(Line word, const char *name)
{
    size_t n = strlen(name);
    if (word.length != n + 1 || memcmp(word.text, name, n) != 0) return -1;
    return word.text[n] >= '0' && word.text[n] <= '9' ? word.text[n] - '0' : -1;
}

/* Inputs that strokes lack (velocity, xtilt, ytilt) are treated as constant. */
static WrTipRule rule_of(Line word)
{
    static const struct {
        const char *name;
        WrTipRule rule;
    } rules[] = { { "incremental", WR_TIP_INCREMENTAL },
                  { "angular", WR_TIP_ANGULAR },
                  { "angle", WR_TIP_ANGULAR },
                  { "random", WR_TIP_RANDOM },
                  { "pressure", WR_TIP_PRESSURE } };
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
        if (is(word, rules[i].name)) return rules[i].rule;
    return WR_TIP_CONSTANT;
}

typedef struct Ranks {
    int dim;
    int rank[WR_TIP_RANKS];
    WrTipRule rule[WR_TIP_RANKS];
} Ranks;

static Ranks read_ranks(Line line)
{
    Ranks r = { .dim = 1 };
    Line word;
    for (int i = 0; i < WR_TIP_RANKS; i++) r.rule[i] = WR_TIP_INCREMENTAL;
    while (next_word(&line, &word)) {
        const uint8_t *colon = memchr(word.text, ':', word.length);
        if (!colon) continue;
        size_t n = (size_t)(colon - word.text);
        Line name = { word.text, n }, value = { colon + 1, word.length - n - 1 };
        int number = 0, at = numbered(name, "rank");
        if (is(name, "dim") && whole_number(value, &number)) r.dim = number;
        if (at >= 0 && at < WR_TIP_RANKS && whole_number(value, &number)) r.rank[at] = number;
        at = is(name, "selection") ? 0 : numbered(name, "sel");
        if (at < 0) at = numbered(name, "selection");
        if (at >= 0 && at < WR_TIP_RANKS) r.rule[at] = rule_of(value);
    }
    return r;
}

/* Ranks that do not match the number of cells are replaced by one rank of all cells, with the first's
 * rule. */
static void set_ranks(WrTip *tip, const Ranks *r)
{
    int64_t product = 1;
    bool good = r->dim >= 1 && r->dim <= WR_TIP_RANKS;
    for (int i = 0; good && i < r->dim; i++) {
        good = r->rank[i] >= 1 && r->rank[i] <= tip->cells;
        product *= good ? r->rank[i] : 0;
    }
    tip->rule[0] = r->rule[0];
    if (!good || product != tip->cells) return;
    tip->ranks = r->dim;
    for (int i = 0; i < r->dim; i++) {
        tip->rank[i] = r->rank[i];
        tip->rule[i] = r->rule[i];
    }
}

static bool read_cells(WrTip *tip, const uint8_t *bytes, size_t size, const char *what,
                       WrError *err)
{
    size_t used = 0;
    for (int i = 0; i < tip->cells; i++) {
        size_t length = 0;
        double *spacing = i == 0 ? &tip->spacing : NULL;
        if (!tip_parse_gbr(tip, i, bytes + used, size - used, &length, NULL, spacing, what, err)) {
            wr_error_prefix(err, "picture %d of %d: ", i + 1, tip->cells);
            return false;
        }
        used += length;
    }
    return true;
}

/* Parses a whole .gih. */
static WrTip *tip_parse_gih(const uint8_t *bytes, size_t size, const char *what, WrError *err)
{
    size_t offset = 0;
    Line name, line, word;
    int count = 0;
    if (!next_line(bytes, size, &offset, &name) || !next_line(bytes, size, &offset, &line) ||
        !next_word(&line, &word) || !whole_number(word, &count)) {
        wr_fail(err,
                "%s: not a brush of GIMP: neither a .gbr header, nor a .gih's two lines with "
                "a name and a number of pictures",
                what);
        return NULL;
    }
    if (count < 1 || count > WR_TIP_CELLS) {
        wr_fail(err, "%s: %d pictures: must be 1..%d", what, count, WR_TIP_CELLS);
        return NULL;
    }
    WrTip *tip = wr_tip_blank(count);
    if (!read_cells(tip, bytes + offset, size - offset, what, err)) {
        wr_tip_free(tip);
        return NULL;
    }
    Ranks ranks = read_ranks(line);
    set_ranks(tip, &ranks);
    tip->name = tip_clean_name(name.text, name.length);
    return tip;
}

/* ---- creation ---- */

WrTip *wr_tip_blank(int cells)
{
    WrTip *tip = wr_alloc(1, sizeof *tip);
    tip->refs = 1;
    tip->cells = cells;
    tip->cell = wr_alloc((size_t)cells, sizeof *tip->cell);
    tip->ranks = 1;
    tip->rank[0] = cells;
    tip->rule[0] = WR_TIP_INCREMENTAL;
    return tip;
}

WrTip *wr_tip_share(const WrTip *tip)
{
    WrTip *shared = (WrTip *)tip; /* only the reference count changes, atomically */
    if (shared) __atomic_fetch_add(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_tip_free(WrTip *tip)
{
    if (!tip || __atomic_sub_fetch(&tip->refs, 1, __ATOMIC_ACQ_REL) > 0) return;
    for (int i = 0; i < tip->cells; i++) wr_free(tip->cell[i].values);
    wr_free(tip->cell);
    wr_free(tip->name);
    wr_free(tip);
}

bool wr_tip_cell_alloc(WrTip *tip, int cell, int width, int height, const char *what, WrError *err)
{
    if (width < 1 || width > WR_TIP_SIDE || height < 1 || height > WR_TIP_SIDE)
        return wr_fail(err, "%s: a tip of %dx%d pixels: each side must be 1..%d", what, width,
                       height, WR_TIP_SIDE);
    WrTipCell made = { .levels = 0 };
    size_t count = 0;
    /* All mip levels lie in one block: level l is values[start[l]], [height[l]][width[l]], sizes halved and rounded up. */
    for (int w = width, h = height;; w = (w + 1) / 2, h = (h + 1) / 2) {
        made.width[made.levels] = w;
        made.height[made.levels] = h;
        made.start[made.levels++] = count;
        count += (size_t)w * (size_t)h;
        if (w == 1 && h == 1) break;
    }
    size_t bytes = count * sizeof *made.values;
    if (bytes > WR_TIP_BYTES - tip->bytes)
        return wr_fail(err, "%s: over %u MB with its mip levels: use a smaller tip", what,
                       WR_TIP_BYTES >> 20);
    made.values = wr_try_alloc(count, sizeof *made.values, "a brush tip", err);
    if (!made.values) return false;
    tip->bytes += bytes;
    tip->cell[cell] = made;
    return true;
}

static float unit(float x)
{
    return x > 0.0f ? x < 1.0f ? x : 1.0f : 0.0f; /* NaN becomes 0 */
}

bool wr_tip_cell_build_levels(WrTip *tip, int cell, int codes, WrError *err)
{
    WrTipCell *c = &tip->cell[cell];
    size_t count = (size_t)c->width[0] * (size_t)c->height[0];
    if (codes > 0) {
        if (!tip_smooth(c->values, c->width[0], c->height[0], err)) return false;
        for (size_t i = 0; i < count; i++) c->values[i] = unit(c->values[i] / (float)codes);
    } else {
        for (size_t i = 0; i < count; i++) c->values[i] = unit(c->values[i]);
    }
    for (int l = 1; l < c->levels; l++)
        tip_halve(c->values + c->start[l - 1], c->width[l - 1], c->height[l - 1],
                  c->values + c->start[l], c->width[l], c->height[l]);
    return true;
}

WrTip *wr_tip_new(int width, int height, const float *values, int codes, WrError *err)
{
    if (codes < 0 || codes > 65535) {
        wr_fail(err, "a tip of %d codes: must be 0..65535", codes);
        return NULL;
    }
    WrTip *tip = wr_tip_blank(1);
    if (!wr_tip_cell_alloc(tip, 0, width, height, "tip", err)) goto fail;
    float *out = tip->cell[0].values;
    size_t count = (size_t)width * (size_t)height;
    for (size_t i = 0; i < count; i++) out[i] = unit(values[i]) * (float)(codes > 0 ? codes : 1);
    if (!wr_tip_cell_build_levels(tip, 0, codes, err)) goto fail;
    return tip;
fail:
    wr_tip_free(tip);
    return NULL;
}

WrTip *wr_tip_parse(const void *bytes, size_t size, const char *name, WrError *err)
{
    if (!tip_is_gbr(bytes, size)) return tip_parse_gih(bytes, size, name, err);
    WrTip *tip = wr_tip_blank(1);
    size_t used;
    if (!tip_parse_gbr(tip, 0, bytes, size, &used, &tip->name, &tip->spacing, name, err)) {
        wr_tip_free(tip);
        return NULL;
    }
    return tip;
}

/* ---- queries ---- */

const char *wr_tip_name(const WrTip *tip)
{
    return tip->name ? tip->name : "";
}

double wr_tip_spacing(const WrTip *tip)
{
    return tip->spacing;
}

int wr_tip_cells(const WrTip *tip)
{
    return tip->cells;
}

void wr_tip_size(const WrTip *tip, int cell, int *width, int *height)
{
    *width = tip->cell[cell].width[0];
    *height = tip->cell[cell].height[0];
}

/* ---- selection of a cell ---- */

/* 0..rank - 1. The first cell of an angular rank points up, the following ones clockwise. */
static int angular(double direction_rad, int rank)
{
    double turns = isfinite(direction_rad) ? 0.25 - direction_rad / (2.0 * WR_PI) : 0.0;
    turns -= floor(turns);
    int index = (int)rint(turns * rank);
    return index < rank ? index : 0;
}

int wr_tip_pick(const WrTip *tip, uint64_t number, double direction_rad, double pressure,
                double random)
{
    int cell = 0;
    random = random > 0.0 ? random < 1.0 ? random : 0x1.fffffffffffffp-1 : 0.0;
    pressure = pressure > 0.0 ? pressure < 1.0 ? pressure : 1.0 : 0.0;
    for (int r = 0; r < tip->ranks; r++) {
        int rank = tip->rank[r], index = 0;
        switch (tip->rule[r]) {
        case WR_TIP_INCREMENTAL: index = (int)(number % (uint64_t)rank); break;
        case WR_TIP_RANDOM:
            random *= rank;
            index = (int)random;
            random -= index; /* the remainder is used for the next rank */
            break;
        case WR_TIP_ANGULAR: index = angular(direction_rad, rank); break;
        case WR_TIP_PRESSURE: index = (int)rint(pressure * (rank - 1)); break;
        case WR_TIP_CONSTANT: break;
        }
        /* Mixed-radix number of the ranks' indices, as GIMP's brush pipes store their cells. */
        cell = cell * rank + index;
    }
    return cell < tip->cells ? cell : 0;
}

/* ---- sampling ---- */

void wr_tip_view(const WrTip *tip, int cell, double scale, WrTipView *view)
{
    const WrTipCell *c = &tip->cell[cell];
    double depth = scale > 0.0 && scale < 1.0 ? -wr_log2(scale) : 0.0;
    if (!(scale > 0.0)) depth = WR_TIP_LEVELS;
    int level = depth < c->levels - 1 ? (int)depth : c->levels - 1;
    *view = (WrTipView){ .fine = c->values + c->start[level],
                         .fine_w = c->width[level],
                         .fine_h = c->height[level] };
    if (level == c->levels - 1 || depth == level) return;
    view->coarse = c->values + c->start[level + 1];
    view->coarse_w = c->width[level + 1];
    view->coarse_h = c->height[level + 1];
    view->mix = (float)(depth - level);
}

static float tap(const float *values, int w, int h, int i, int j)
{
    return i >= 0 && i < w && j >= 0 && j < h ? values[(size_t)j * (size_t)w + (size_t)i] : 0.0f;
}

/* Bilinear; the picture is surrounded by 0. */
static float bilinear(const float *values, int w, int h, double s, double t)
{
    double x = s * w - 0.5, y = t * h - 0.5;
    if (!(x > -1.0 && x < w && y > -1.0 && y < h)) return 0.0f;
    double i = floor(x), j = floor(y);
    float fx = (float)(x - i), fy = (float)(y - j);
    int column = (int)i, row = (int)j;
    float a = tap(values, w, h, column, row), b = tap(values, w, h, column + 1, row);
    float c = tap(values, w, h, column, row + 1), d = tap(values, w, h, column + 1, row + 1);
    float top = a + fx * (b - a), bottom = c + fx * (d - c);
    return top + fy * (bottom - top);
}

float wr_tip_value(const WrTipView *view, double s, double t)
{
    float fine = bilinear(view->fine, view->fine_w, view->fine_h, s, t);
    if (!view->coarse) return fine;
    float coarse = bilinear(view->coarse, view->coarse_w, view->coarse_h, s, t);
    return fine + view->mix * (coarse - fine);
}
