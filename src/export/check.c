#include "export/check.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "export/export.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/normal_map.h"

#include <math.h>
#include <string.h>

typedef struct WrImage WrImage;

/* A picture whose first `colours` numbers per texel are checked; the rest is coverage. */
typedef struct WrCheckPicture {
    const WrImage *image;
    int colours;
} WrCheckPicture;

/* ---- Test for slopes being the gradient of one height field ---- */

#define CLEARLY 4 /* factor over the effect of rounding on the sum */

/* Sums over D_v p and D_u q: squares, their product, and the mean effect of rounding on the squares. */
typedef struct Sums {
    double pp, qq, pq, noise_p, noise_q;
} Sums;

/* Slopes of texel (i, j); returns the mean square of the error caused by rounding a code by `step`. Rounding errors are
   uniform over a step, variance step^2 / 12. With p = -n_x / n_z an error of n_x is divided by n_z, one of n_z at most by
   n_z^2: step / n_z^2 bounds both. */
static double slopes_at(const WrImage *map, int i, int j, double step, double *p, double *q)
{
    const float *n = map->data + 3 * ((size_t)j * (size_t)map->width + (size_t)i);
    const double error = step / ((double)n[2] * (double)n[2]);
    wr_normal_map_slopes(n, p, q);
    return error * error / 12;
}

static void add_texel(const WrImage *map, int i, int j, double step, Sums *sums)
{
    double p[2], q[2], other;
    sums->noise_p += slopes_at(map, i, j - 1, step, &p[0], &other);
    sums->noise_p += slopes_at(map, i, j + 1, step, &p[1], &other);
    sums->noise_q += slopes_at(map, i + 1, j, step, &other, &q[0]);
    sums->noise_q += slopes_at(map, i - 1, j, step, &other, &q[1]);
    const double dp = p[0] - p[1], dq = q[0] - q[1];
    sums->pp += dp * dp;
    sums->qq += dq * dq;
    sums->pq += dp * dq;
}

/* Computes curl for unit vectors from codes that are `step` apart. A gradient has D_v p = D_u q: the
   correlation r of the two over the map is 1 for heights, 0 for unrelated slopes, and curl = sqrt(1 - r). Rounding noise lowers
   r, since it adds to the squares but not to the product: its mean is subtracted from the squares first. */
static void check_curl(const WrImage *map, double step, WrCheckNormals *normals)
{
    Sums s = { 0 };
    for (int j = 1; j < map->height - 1; j++)
        for (int i = 1; i < map->width - 1; i++) add_texel(map, i, j, step, &s);
    const double pp = s.pp - s.noise_p, qq = s.qq - s.noise_q;
    normals->curl_known = pp > CLEARLY * s.noise_p || qq > CLEARLY * s.noise_q;
    const double both = pp > 0 && qq > 0 ? s.pq / sqrt(pp * qq) : 0;
    normals->curl = sqrt(1 - fmax(-1, fmin(1, both)));
}

/* ---- Number of distinct values of a picture, and the fewest bits that represent them ---- */

#define ENOUGH 8 /* minimum of values besides black and white for detecting their step */

/* True if every code is one of `bits` bits, spread over all of `total` bits. A code c of `total` bits stems from k = round(c
   few / last) if spreading k back yields c; so 8 bits widened to 16 by a factor of 257 are found, as are 10 or 12 bits. */
static bool spread(const bool *seen, int total, int bits)
{
    const double last = (1 << total) - 1, few = (1 << bits) - 1;
    for (int c = 0; c < 1 << total; c++)
        if (seen[c] && floor(floor(c * few / last + 0.5) * last / few + 0.5) != c) return false;
    return true;
}

/* True if every code has `bits` bits and zeros below. */
static bool shifted(const bool *seen, int total, int bits)
{
    for (int c = 0; c < 1 << total; c++)
        if (seen[c] && c & ((1 << (total - bits)) - 1)) return false;
    return true;
}

static size_t texels_of(const WrCheckPicture *p)
{
    return (size_t)p->image->width * (size_t)p->image->height;
}

static const float *texel_of(const WrCheckPicture *p, size_t i)
{
    return p->image->data + i * (size_t)p->image->channels;
}

static void count_codes(const WrCheckPicture *p, int total, WrCheckNumbers *n)
{
    bool *seen = wr_alloc(WR_CHECK_DISTINCT, sizeof *seen);
    const int last = (1 << total) - 1;
    for (size_t i = 0; i < texels_of(p); i++)
        for (int c = 0; c < p->colours; c++) {
            const int code = (int)((double)texel_of(p, i)[c] * last + 0.5);
            seen[code < 0 ? 0 : code > last ? last : code] = true;
        }
    for (int c = 0; c <= last; c++) n->distinct += seen[c];
    n->judged = n->distinct - seen[0] - seen[last] >= ENOUGH;
    n->bits = 1;
    while (n->judged && n->bits < total && !spread(seen, total, n->bits) &&
           !shifted(seen, total, n->bits))
        n->bits++;
    if (!n->judged) n->bits = total;
    wr_free(seen);
}

/* ---- floats ---- */

/* Hash set of numbers by their bits, limited to WR_CHECK_DISTINCT. Slots contain bits + 1, 0: empty. */
typedef struct Set {
    uint64_t *slot; /* [2 * WR_CHECK_DISTINCT] */
    int count;
} Set;

static uint32_t bits_of(float x)
{
    uint32_t bits;
    x += 0.0f; /* -0 becomes 0 */
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static void add(Set *set, float x)
{
    const uint32_t bits = bits_of(x), mask = 2 * WR_CHECK_DISTINCT - 1;
    if (set->count == WR_CHECK_DISTINCT) return;
    /* Multiplicative hashing with linear probing. The table has twice as many slots as it may hold numbers, so probes stay
       short and a free slot always exists. */
    uint32_t at = (bits * 0x9e3779b1u) >> 15 & mask;
    while (set->slot[at] && set->slot[at] != (uint64_t)bits + 1) at = (at + 1) & mask;
    set->count += !set->slot[at];
    set->slot[at] = (uint64_t)bits + 1;
}

/* True if half precision represents it: 11 digits; below 2^-14 multiples of 2^-24. */
static bool is_half(float x)
{
    const double size = fabs((double)x);
    if (size > 65504) return false;
    return size < 0x1p-14 ? size * 0x1p24 == floor(size * 0x1p24) : (bits_of(x) & 0x1fff) == 0;
}

/* True if it is a code k of 0..last stored as a float k/last, up to rounding. */
static bool is_code(float x, double last)
{
    const double code = (double)x * last;
    return code >= 0 && code <= last && fabs(code - floor(code + 0.5)) <= last * 0x1p-22;
}

static void count_floats(const WrCheckPicture *p, WrCheckNumbers *n)
{
    Set set = { wr_alloc((size_t)2 * WR_CHECK_DISTINCT, sizeof *set.slot), 0 };
    bool eight = true, sixteen = true, half = true;
    for (size_t i = 0; i < texels_of(p); i++)
        for (int c = 0; c < p->colours; c++) {
            const float x = texel_of(p, i)[c];
            add(&set, x);
            half = half && is_half(x);
            eight = eight && is_code(x, 255);
            sixteen = sixteen && is_code(x, 65535);
        }
    n->distinct = set.count;
    n->judged = set.count >= ENOUGH + 2;
    n->half = n->judged && half;
    n->bits = !n->judged ? 32 : eight ? 8 : sixteen || half ? 16 : 32;
    wr_free(set.slot);
}

/* ---- whole picture ---- */

static void find_range(const WrCheckPicture *p, WrCheckNumbers *n)
{
    n->low = INFINITY, n->high = -INFINITY;
    for (size_t i = 0; i < texels_of(p); i++)
        for (int c = 0; c < p->colours; c++) {
            n->low = fmin(n->low, (double)texel_of(p, i)[c]);
            n->high = fmax(n->high, (double)texel_of(p, i)[c]);
        }
}

static void count_ends(const WrCheckPicture *p, WrCheckNumbers *n)
{
    int64_t low = 0, high = 0;
    for (size_t i = 0; i < texels_of(p); i++)
        for (int c = 0; c < p->colours; c++) {
            low += (double)texel_of(p, i)[c] <= n->low;
            high += (double)texel_of(p, i)[c] >= n->high;
        }
    const double all = (double)texels_of(p) * p->colours;
    n->at_low = (double)low / all;
    n->at_high = (double)high / all;
}

/* check.c */
static void check_numbers(const WrCheckPicture *picture, WrCheckNumbers *numbers)
{
    *numbers = (WrCheckNumbers){ 0 };
    find_range(picture, numbers);
    count_ends(picture, numbers);
    if (picture->image->type == WR_PIXEL_F32) count_floats(picture, numbers);
    else count_codes(picture, picture->image->type == WR_PIXEL_U8 ? 8 : 16, numbers);
}

/* Distance of two neighbouring numbers, as far as known; 0 for floats. */
static double check_step(const WrCheckNumbers *numbers)
{
    const double size = fmax(fabs(numbers->low), fabs(numbers->high));
    if (numbers->bits < 32 && !numbers->half) return 1.0 / ((1 << numbers->bits) - 1);
    return numbers->half ? size * 0x1p-11 : 0;
}

#define NORMAL_OFF 0.15  /* largest mean deviation of lengths from 1 for a normal map */
#define NORMAL_AWAY 0.05 /* largest share of normals that point away */
#define CURLED                                                                                     \
    0.6 /* curl above this: not from a height field; for white noise B-splines give 0.24, Sobel's filter 0.45 */

const char *const wr_check_kinds[] = { WR_CHECK_KINDS(WR_WORD) NULL };
const char *const wr_check_problems[] = { WR_CHECK_PROBLEMS(WR_WORD) NULL };

/* ---- edges ---- */

/* One colour channel as a periodic table; without the border that repeats the first column and row. */
static WrField *field_of(const WrCheckPicture *p, int colour, bool border, WrError *err)
{
    const int w = p->image->width - border, h = p->image->height - border;
    const size_t step = (size_t)p->image->channels;
    if (w < 1 || h < 1) {
        wr_fail(err, "a picture of one row or column cannot have a border");
        return NULL;
    }
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err);
    float *row = wr_alloc_unset((size_t)w, sizeof *row);
    for (int j = 0; field && j < h; j++) {
        const float *from = p->image->data + (size_t)j * (size_t)p->image->width * step;
        for (int i = 0; i < w; i++) row[i] = from[(size_t)i * step + (size_t)colour];
        wr_field_write(field, 0, j, w, 1, row, (size_t)w);
    }
    wr_free(row);
    return field;
}

static double worst_ratio(const WrSeamEdge *e)
{
    return e->ratio[wr_seam_worst(e)];
}

static void take_worse(const WrSeamEdge *e, WrCheckEdge *edge)
{
    if (e->measured && edge->judged &&
        (e->order > edge->test.order ||
         (e->order == edge->test.order && worst_ratio(e) <= worst_ratio(&edge->test))))
        return;
    edge->judged = e->measured;
    edge->test = *e;
}

/* Judges the axis with index `axis` in the label. */
static void judge(const WrImageLabel *label, int axis, WrCheckEdge *edge)
{
    edge->seam = edge->judged && wr_seam_shows(&edge->test);
    if (!label->edged || !edge->judged) return;
    if (label->edge[axis] >= 1)
        edge->seam = edge->seam && worst_ratio(&edge->test) > WR_CHECK_SURELY;
    else if (!edge->seam) edge->seam = edge->by_label = true;
}

/* True if the last column (row) equals the first. */
static bool is_repeated(const WrCheckPicture *p, bool columns)
{
    const int w = p->image->width, h = p->image->height, step = p->image->channels;
    const int length = columns ? h : w;
    const size_t along = (size_t)step * (columns ? (size_t)w : 1);
    const size_t last = (size_t)step * (columns ? (size_t)(w - 1) : (size_t)w * (size_t)(h - 1));
    for (size_t k = 0; k < (size_t)length; k++)
        for (int c = 0; c < p->colours; c++) {
            const float *first = p->image->data + k * along + c;
            if (first[0] < first[last] || first[0] > first[last]) return false;
        }
    return true;
}

static bool check_edges(const WrCheckPicture *p, WrCheck *check, WrError *err)
{
    const WrImageLabel *label = &p->image->label;
    const WrSeamOptions how = { .copies = { label->copies[0], label->copies[1] },
                                .noise = check_step(&check->numbers) };
    for (int c = 0; c < p->colours && !label->open; c++) {
        if (wr_progress_stopped()) return wr_fail(err, "cancelled");
        WrField *field = field_of(p, c, label->border, err);
        if (!field) return false;
        const WrSeam seam = wr_seam_measure(field, &how);
        wr_field_free(field);
        take_worse(&seam.u, &check->u);
        take_worse(&seam.v, &check->v);
    }
    judge(label, 0, &check->u);
    judge(label, 1, &check->v);
    check->u.repeats = check->u.seam && is_repeated(p, true);
    check->v.repeats = check->v.seam && is_repeated(p, false);
    return true;
}

/* ---- kind of picture ---- */

static bool is_grey(const WrImage *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        const float *t = image->data + i * (size_t)image->channels;
        if (t[0] < t[1] || t[0] > t[1] || t[1] < t[2] || t[1] > t[2]) return false;
    }
    return true;
}

static bool looks_normal(const WrImage *image, const WrNormalMapReport *report)
{
    const double texels = (double)image->width * (double)image->height;
    return report->off_mean < NORMAL_OFF &&
           (double)(report->away - report->level) < NORMAL_AWAY * texels;
}

static const char *label_of(const WrImageLabel *label)
{
    static const char kind[] = "wrinkle:kind=";
    if (label->kind == WR_LABEL_HEIGHT) return "height";
    if (label->kind == WR_LABEL_NORMAL_UP) return "normal+y";
    if (label->kind == WR_LABEL_NORMAL_DOWN) return "normal-y";
    if (strncmp(label->refused, kind, sizeof kind - 1) != 0) return NULL;
    const WrExportKind *export = wr_export_find(label->refused + sizeof kind - 1);
    return export ? export->name : NULL;
}

static WrCheckKind kind_of(const WrImage *image, const WrNormalMapReport *report,
                           const WrCheck *check)
{
    const WrLabelKind label = image->label.kind;
    if (label == WR_LABEL_NORMAL_UP || label == WR_LABEL_NORMAL_DOWN) return WR_CHECK_NORMAL;
    if (image->channels < 3 || label == WR_LABEL_HEIGHT || is_grey(image)) return WR_CHECK_HEIGHT;
    if (check->label || !looks_normal(image, report)) return WR_CHECK_COLOUR;
    return WR_CHECK_NORMAL;
}

/* ---- normals ---- */

static void take_report(const WrNormalMapReport *report, WrCheckNormals *normals)
{
    normals->green_known = !report->undecided;
    normals->green_down = report->green_down;
    normals->lengths = report->channels == 3;
    normals->own = report->own;
    normals->centred = report->centred;
    normals->off = report->off;
    normals->away = report->away - report->level;
    normals->converted = report->converted;
}

static bool check_normals(const WrImage *image, int kind, WrCoding coding, WrCheck *check,
                          WrError *err)
{
    WrNormalMapReport report = { 0 };
    const bool could = kind == WR_CHECK_NORMAL || (kind < 0 && image->channels >= 3);
    WrImage *map =
        could ? wr_normal_map_decode(image, WR_GREEN_AUTO, 0, coding, &report, err) : NULL;
    if (could && !map) return false;
    check->kind = kind < 0 ? kind_of(image, &report, check) : (WrCheckKind)kind;
    const bool codes = check->numbers.bits < 32;
    const double step = codes ? 2.0 / ((1 << check->numbers.bits) - 1) : 1e-6;
    if (check->kind == WR_CHECK_NORMAL && map) {
        take_report(&report, &check->normals);
        check_curl(map, step, &check->normals);
    }
    wr_image_free(map);
    return true;
}

/* Converts slopes (p, q) to the normals that have them. */
static bool check_slopes(const WrImage *slopes, WrCheck *check, WrError *err)
{
    WrNormalMapReport report;
    WrImage *normals = wr_image_new(slopes->width, slopes->height, 3, err);
    if (!normals) return false;
    normals->type = WR_PIXEL_F32;
    for (size_t i = 0; i < (size_t)slopes->width * (size_t)slopes->height; i++) {
        const double p = (double)slopes->data[2 * i], q = (double)slopes->data[2 * i + 1];
        const double unit = 1 / sqrt(1 + p * p + q * q);
        normals->data[3 * i] = (float)(-p * unit);
        normals->data[3 * i + 1] = (float)(-q * unit);
        normals->data[3 * i + 2] = (float)unit;
    }
    WrImage *map = wr_normal_map_decode(normals, WR_GREEN_AUTO, 3, WR_CODING_SIGNED, &report, err);
    if (map) {
        take_report(&report, &check->normals);
        check->normals.lengths = false; /* computed here */
        check_curl(map, 1e-6, &check->normals);
    }
    wr_image_free(map);
    wr_image_free(normals);
    check->kind = WR_CHECK_SLOPES;
    return map != NULL;
}

/* ---- problems ---- */

/* Largest deviation of a length from 1 by rounding, in each number: half a code of 2/M, or a whole one where 0
   has a code of its own. Codes made without such a zero and read with it (most of the map is flat) are off by up
   to half a code more, and by one whole code near -1. */
static double most_off(const WrCheck *check)
{
    if (check->numbers.half) return 2e-3;
    const double halves = check->normals.centred ? 3 : 2;
    return check->numbers.bits < 32 ? halves * sqrt(3) / ((1 << check->numbers.bits) - 1) : 1e-4;
}

static bool labels_lie(const WrImage *image, const WrCheck *check)
{
    const bool down = image->label.kind == WR_LABEL_NORMAL_DOWN;
    const bool report = down || image->label.kind == WR_LABEL_NORMAL_UP;
    if (image->label.refused[0] && !label_of(&image->label)) return true;
    if (image->label.refused[0] && image->label.kind != WR_LABEL_NONE) return true;
    return report && check->normals.green_known && check->normals.green_down != down;
}

static void find_problems(const WrImage *image, WrCheck *check)
{
    const WrCheckNormals *n = &check->normals;
    const bool found[WR_CHECK_PROBLEM_COUNT] = {
        [WR_CHECK_SEAM_U] = check->u.seam,
        [WR_CHECK_SEAM_V] = check->v.seam,
        [WR_CHECK_LOST] = check->replaced > 0,
        [WR_CHECK_STEPS] = check->depth > 8 && check->numbers.judged && check->numbers.bits <= 8,
        [WR_CHECK_LENGTH] = n->lengths && n->off > most_off(check),
        [WR_CHECK_AWAY] = n->away > 0,
        [WR_CHECK_CURL] = n->curl_known && n->curl > CURLED,
        [WR_CHECK_CONVERTED] = n->converted,
        [WR_CHECK_LABEL] = labels_lie(image, check),
    };
    for (int i = 0; i < WR_CHECK_PROBLEM_COUNT; i++) check->problems |= (unsigned)found[i] << i;
}

/* ---- files ---- */

static bool check_image(const WrImage *image, int colours, int kind, WrCoding coding,
                        WrCheck *check, WrError *err)
{
    const WrCheckPicture picture = { image, colours };
    check->width = image->width;
    check->height = image->height;
    check->channels = image->channels;
    check->depth = image->type == WR_PIXEL_U8 ? 8 : image->type == WR_PIXEL_U16 ? 16 : 32;
    check->replaced = image->replaced;
    check->label = label_of(&image->label);
    check_numbers(&picture, &check->numbers);
    const bool slopes = kind == WR_CHECK_SLOPES;
    if (!(slopes ? check_slopes(image, check, err)
                 : check_normals(image, kind, coding, check, err)) ||
        !check_edges(&picture, check, err))
        return false;
    find_problems(image, check);
    return true;
}

/* The two float channels of a file's first part, if it has two and they are not grey and coverage; else NULL; an
   error only on failure. */
static WrImage *read_slopes(const char *path, WrError *err)
{
    WrImageFile *file = wr_image_file_open(path, err);
    if (!file) return NULL;
    const WrImagePart part = wr_image_file_part(file, 0);
    const char *second = part.channels == 2 ? part.channel_names[1] : "A";
    const bool two = part.type == WR_PIXEL_F32 && strcmp(second, "A") != 0;
    WrImage *slopes = two ? wr_image_new(part.width, part.height, 2, err) : NULL;
    if (slopes && !wr_image_file_read(file, 0, slopes->data, err)) {
        wr_image_free(slopes);
        slopes = NULL;
    }
    wr_image_file_close(file);
    return slopes;
}

/* Sets non-finite values to 0 and counts them. */
static void replace_lost(WrImage *slopes)
{
    const size_t count = (size_t)slopes->width * (size_t)slopes->height;
    for (size_t i = 0; i < count; i++) {
        float *t = slopes->data + 2 * i;
        slopes->replaced += !isfinite(t[0]) || !isfinite(t[1]);
        for (int c = 0; c < 2; c++) t[c] = isfinite(t[c]) ? t[c] : 0;
    }
}

/* Replaces a picture of which only the first of two channels was read. */
static WrImage *take_slopes(const char *path, WrImage *image, WrError *err)
{
    WrError none = { "" };
    WrImage *slopes = read_slopes(path, &none);
    if (none.text[0]) *err = none;
    if (slopes) {
        slopes->type = WR_PIXEL_F32;
        slopes->label = image->label;
        replace_lost(slopes);
    }
    if (slopes || none.text[0]) wr_image_free(image);
    return slopes ? slopes : none.text[0] ? NULL : image;
}

static int colours_of(const WrImage *image, int kind)
{
    if (image->channels >= 3) return 3;
    return kind == WR_CHECK_SLOPES || kind == WR_CHECK_NORMAL ? image->channels : 1;
}

bool wr_check_picture(const char *path, int kind, WrCoding coding, WrCheck *check, WrError *err)
{
    *check = (WrCheck){ 0 };
    WrImage *image = wr_image_read(path, err);
    const bool part =
        image && image->type == WR_PIXEL_F32 && (image->taken[0] || image->channels == 2);
    if (part && (kind < 0 || kind == WR_CHECK_SLOPES)) {
        WrImage *both = take_slopes(path, image, err);
        if (both && both != image) kind = WR_CHECK_SLOPES;
        image = both;
    }
    if (!image) return false;
    if (kind == WR_CHECK_SLOPES && image->channels != 2) {
        wr_image_free(image);
        return wr_fail(err, "%s: slopes are two float channels, which this format cannot store",
                       path);
    }
    const bool good = check_image(image, colours_of(image, kind), kind, coding, check, err);
    wr_image_free(image);
    return good;
}
