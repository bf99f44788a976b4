/* Removal of quantization steps from 8-bit tips, and the smaller mip levels of a tip.

   A code represents any value within half a step of it. Of all pictures with these codes the smoothest
   is wanted: the limit of diffusion with each value kept within its half step. The flat parts of a
   gentle slope are wide, and diffusion is slow, so it starts on small pictures: the codes are halved by
   box means up to WR_SMOOTH_LEVELS times, and from the smallest up each picture is enlarged (bilinear),
   clamped to its bounds, and diffused a little ([1 2 1]/4 in both directions). If codes differ by over
   1.5 from one pixel to the next there is an edge or texture, not a quantization step: such pixels keep
   their code, and the smaller pictures have a hole (NaN) there, so that nothing spreads over an edge:
   black pixels beside one stay exactly black. */
#include "brush/tip_internal.h"

#include "base/error.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

#define WR_SMOOTH_LEVELS 8
#define WR_SMOOTH_MOST 24 /* maximum steps of diffusion for each level */
#define WR_SMOOTH_LEAST 6
#define WR_SMOOTH_WORK (1 << 27) /* pixels times steps, above which fewer steps are used */
#define WR_SMOOTH_STAIR 1.5f     /* codes; larger differences are edges */

/* ---- sizes ---- */

/* The inputs covered by output i of out_n, of in_n in total, and the weights of the first and last one. */
typedef struct Span {
    int first, last;
    double head, tail, inverse; /* covered fractions of the first and last; 1/length */
} Span;

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

void wr_tip_halve(const float *in, int in_w, int in_h, float *out, int out_w, int out_h)
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
    wr_tip_halve(in->values, in->width, in->height, out->values, out->width, out->height);
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

bool wr_tip_smooth(float *values, int width, int height, WrError *err)
{
    Picture codes[WR_SMOOTH_LEVELS + 1] = { { .values = NULL } }, smooth = { .values = NULL };
    Picture given = { values, width, height };
    float *rows = wr_try_alloc((size_t)width * 3, sizeof *rows, "smoothing a brush tip", err);
    int last = 0, steps = WR_SMOOTH_WORK / (width * height);
    steps = steps < WR_SMOOTH_LEAST ? WR_SMOOTH_LEAST : steps;
    steps = steps > WR_SMOOTH_MOST ? WR_SMOOTH_MOST : steps;
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
