/* Scratches: chains of short straight pieces, in coordinates before the origin is moved. Each exists
   with all its periodic images. The table is divided into buckets that list the pieces near them, so a
   position evaluates only those. The deepest scratch wins, so their order is irrelevant. */
#include "base/array.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "field/field.h"
#include "generate/pattern.h"

#include <math.h>

#define MAX_MOST 2000 /* scratches */
#define PIECES 16     /* of a bent scratch */
#define BLUR 0.5      /* half a texel */
#define BUCKETS 128   /* along an axis, at most */

const WrParam wr_params_scratches[] = {
    WR_P_WHOLE("count", "Count", 60, 1, MAX_MOST, 500, "number of scratches"),
    WR_P_TEXELS("length", "Length", 160, 512,
                "length of the longest; at most four times the table's shorter side"),
    WR_P_TEXELS("width", "Width", 3, 16, "width of the widest; at most an eighth of that side"),
    WR_P_NUMBER("angle", "Angle", 20, -360, 360, 180, "degrees", "direction of the scratches"),
    WR_P_NUMBER("spread", "Spread", 25, 0, 180, 180, "degrees",
                "random variation of the direction"),
    WR_P_NUMBER("bend", "Bend", 20, 0, 720, 180, "degrees", "turn of a scratch along its length"),
    WR_P_PART("ridge", "Burr", 0.25, "height of the rim beside a scratch"),
    WR_P_PART("vary", "Vary", 0.7, "random reduction of length and depth"),
    WR_P_SEED,
    WR_P_NUMBER("height", "Depth", 0.1, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "depth of the deepest; below 0 they are raised"),
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Piece {
    double x, y;         /* start in texels from the origin, within the table */
    double dx, dy;       /* vector to its end */
    double from, to;     /* along the scratch, 0..1 */
    double depth, width; /* at its middle: 0..1, texels */
} Piece;

typedef WR_ARRAY(int) Bucket;

typedef struct Scratches {
    double width, height, ridge;
    Piece *pieces; /* owned */
    int count;
    int across, rows; /* buckets */
    Bucket *buckets;  /* [rows][across], owned */
} Scratches;

static double signed_chance(uint32_t seed, int i, int use)
{
    return 2.0 * wr_chance(seed, i, 0, use) - 1.0;
}

/* Lengths and directions do not depend on the table; positions are multiples of 2^-24 of it, so that
 * differences of positions are exact. */
static void draw_scratch(Scratches *s, const WrParams *p, int i)
{
    uint32_t seed = wr_param_seed(p);
    double vary = wr_param_number(p, "vary");
    double side =
        s->width < s->height ? s->width : s->height; /* pieces shorter than a quarter of it */
    double longest = wr_param_number(p, "length"), widest = wr_param_number(p, "width");
    if (longest > 4.0 * side) longest = 4.0 * side;
    if (widest > 0.125 * side) widest = 0.125 * side;
    double length = longest * (1.0 - vary * wr_chance(seed, i, 0, 1));
    double depth = 1.0 - vary * wr_chance(seed, i, 0, 2);
    double width = widest * (1.0 - 0.5 * vary * wr_chance(seed, i, 0, 3));
    double angle =
        wr_param_number(p, "angle") + wr_param_number(p, "spread") * signed_chance(seed, i, 4);
    double bend = wr_param_number(p, "bend") * signed_chance(seed, i, 5);
    double x = s->width * wr_chance(seed, i, 0, 6), y = s->height * wr_chance(seed, i, 0, 7);
    for (int k = 0; k < PIECES; k++) {
        double sine, cosine, part = (k + 0.5) / PIECES - 0.5;
        wr_sincos_turns((angle + bend * part) / 360.0, &sine, &cosine);
        double step = length / PIECES;
        s->pieces[s->count++] = (Piece){ .x = x,
                                         .y = y,
                                         .dx = floor(4096.0 * step * cosine) / 4096.0,
                                         .dy = floor(4096.0 * step * sine) / 4096.0,
                                         .from = (double)k / PIECES,
                                         .to = (k + 1.0) / PIECES,
                                         .depth = depth,
                                         .width = width };
        const Piece *now = &s->pieces[s->count - 1];
        x += now->dx;
        y += now->dy;
        x -= s->width * floor(x / s->width);
        y -= s->height * floor(y / s->height);
    }
}

/* Maximum distance of the effect of a scratch of this width. */
static double reach_of(double width)
{
    return width + 2.5;
}

/* Buckets from the one at a to the one at b, which may lie outside; at most all of them. */
static void bucket_span(double a, double b, double size, int buckets, int *first, int *count)
{
    *first = (int)floor(a / size * buckets);
    *count = (int)floor(b / size * buckets) - *first + 1;
    if (*count > buckets) *count = buckets;
}

static void put_into_buckets(Scratches *s, int index)
{
    const Piece *p = &s->pieces[index];
    double reach = reach_of(p->width);
    double left = p->dx < 0.0 ? p->x + p->dx : p->x, low = p->dy < 0.0 ? p->y + p->dy : p->y;
    int i, j, ni, nj;
    bucket_span(left - reach, left + fabs(p->dx) + reach, s->width, s->across, &i, &ni);
    bucket_span(low - reach, low + fabs(p->dy) + reach, s->height, s->rows, &j, &nj);
    for (int b = 0; b < nj; b++)
        for (int a = 0; a < ni; a++) {
            Bucket *bucket =
                &s->buckets[wr_modulo(j + b, s->rows) * s->across + wr_modulo(i + a, s->across)];
            wr_array_push(bucket, index);
        }
}

/* The nearest periodic image: d minus whole tables, -size/2..size/2 about `about`. */
static double nearest_image(double d, double about, double size)
{
    return d - size * floor((d - about) / size + 0.5);
}

/* A groove with rims: 1 - t^2 inside, a rim from 1 to 2 half widths, thin and shallow towards both
 * ends. The blur of a texel makes it wider, and shallower by the same factor. */
static double groove(const Scratches *s, const Piece *p, double x, double y)
{
    double ex = nearest_image(x - p->x, 0.5 * p->dx, s->width);
    double ey = nearest_image(y - p->y, 0.5 * p->dy, s->height);
    double along = p->dx * p->dx + p->dy * p->dy, t = 0.0;
    if (along > 0.0) t = (ex * p->dx + ey * p->dy) / along;
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    double rx = ex - t * p->dx, ry = ey - t * p->dy, distance = sqrt(rx * rx + ry * ry);
    double place = p->from + t * (p->to - p->from), taper = 4.0 * place * (1.0 - place);
    double real = 0.5 * p->width * (0.3 + 0.7 * taper), half = sqrt(real * real + BLUR * BLUR);
    double r = distance / half;
    if (r >= 2.0) return 0.0;
    double depth = p->depth * taper * (real / half);
    if (r < 1.0) return -depth * (1.0 - r * r);
    double rim = (r - 1.0) * (2.0 - r);
    return s->ridge * depth * 16.0 * rim * rim;
}

static double scratch_at(const void *ctx, double x, double y)
{
    const Scratches *s = ctx;
    int i = (int)(x / s->width * s->across), j = (int)(y / s->height * s->rows);
    i = i < s->across ? i : s->across - 1;
    j = j < s->rows ? j : s->rows - 1;
    const Bucket *bucket = &s->buckets[j * s->across + i];
    double deepest = 0.0, highest = 0.0;
    for (int k = 0; k < bucket->count; k++) {
        double h = groove(s, &s->pieces[bucket->data[k]], x, y);
        deepest = h < deepest ? h : deepest;
        highest = h > highest ? h : highest;
    }
    return deepest < 0.0 ? deepest : highest;
}

static int bucket_count(double size)
{
    double buckets = floor(size / 16.0);
    return buckets < 1.0 ? 1 : buckets > BUCKETS ? BUCKETS : (int)buckets;
}

bool wr_pattern_scratches(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                          WrError *err)
{
    const WrParams given = { wr_params_scratches, values };
    int count = wr_param_whole(&given, "count");
    Scratches s = { .width = wr_field_width(job->like),
                    .height = wr_field_height(job->like),
                    .ridge = wr_param_number(&given, "ridge") };
    s.across = bucket_count(s.width);
    s.rows = bucket_count(s.height);
    s.pieces = wr_alloc((size_t)count * PIECES, sizeof *s.pieces);
    s.buckets = wr_alloc((size_t)s.across * (size_t)s.rows, sizeof *s.buckets);
    for (int i = 0; i < count; i++) draw_scratch(&s, &given, i);
    for (int k = 0; k < s.count; k++) put_into_buckets(&s, k);
    bool good = wr_pattern_make(&given, job, scratch_at, &s, 2, out, err);
    for (int k = 0; k < s.across * s.rows; k++) wr_array_free(&s.buckets[k]);
    wr_free(s.buckets);
    wr_free(s.pieces);
    return good;
}
