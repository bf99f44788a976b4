/* Hard cases of rasterizing into a table, and of going back and forth in its history. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "brush/brush.h"
#include "document/document.h"
#include "document/history.h"
#include "field/field.h"
#include "generate/generator.h"
#include "image/font.h"

#include <string.h>

/* ---- generators by name ---- */

typedef struct Values {
    const WrGenerator *row;
    WrParamValue value[WR_GENERATOR_PARAMS];
} Values;

static bool values_of(Values *out, const char *family, const char *name, WrError *err)
{
    out->row = wr_generator_find(family, name);
    if (!out->row) return wr_fail(err, "there is no %s %s", family, name ? name : "");
    wr_generator_defaults(out->row, out->value);
    return true;
}

static WrParamValue *param(Values *values, const char *name)
{
    static WrParamValue none;
    const int index = wr_generator_param_find(values->row, name);
    return index >= 0 ? &values->value[index] : &none;
}

static bool make(const Values *values, const WrField *like, WrPool *pool, WrRelief *out,
                 WrError *err)
{
    const WrGenerateJob job = { .like = like, .pool = pool };
    return wr_generator_make(values->row, values->value, &job, out, err);
}

static WrField *blank(int w, int h)
{
    return wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
}

/* ---- text ---- */

static bool write_text(Values *values, const char *text, double u, double v, const WrField *like,
                       WrRelief *out, WrError *err)
{
    param(values, "text")->text = text;
    param(values, "at")->number[0] = u;
    param(values, "at")->number[1] = v;
    return make(values, like, NULL, out, err);
}

/* Number of texels of either part that differ from the other's, moved by half a table. */
static void same_rolled(WrHardGauge *g, const WrRelief *still, const WrRelief *moved, int w, int h)
{
    WrField *heights = wr_hard_rolled(still->heights, w / 2, h / 2);
    WrField *cover = wr_hard_rolled(still->cover, w / 2, h / 2);
    wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_equal(heights, moved->heights));
    wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_equal(cover, moved->cover));
    wr_field_free(heights);
    wr_field_free(cover);
}

static bool hc78(WrHardGauge *g, WrError *err)
{
    enum { W = 64, H = 48 };
    Values values;
    WrRelief none = { NULL, NULL }, still = { NULL, NULL }, moved = { NULL, NULL };
    if (!values_of(&values, "text", NULL, err)) return false;
    WrField *like = blank(W, H);
    param(&values, "size")->number[0] = 60; /* one letter is wider than half the table */
    bool good = write_text(&values, "", 0.5, 0.5, like, &none, err);
    if (good) {
        float low = 1.0f, high = 1.0f;
        if (none.cover) wr_field_range(none.cover, &low, &high);
        wr_hard_holds(g, WR_HARD_FLOAT, low == 0.0f && high == 0.0f);
    }
    good = good && write_text(&values, "Mg\nW", 0.5, 0.5, like, &still, err) &&
           write_text(&values, "Mg\nW", 1.0, 1.0, like, &moved, err);
    if (good) {
        float low, high;
        same_rolled(g, &still, &moved, W, H);
        wr_field_range(still.cover, &low, &high);
        wr_hard_holds(g, WR_HARD_FLOAT, high == 1.0f); /* something is visible */
    }
    wr_relief_fini(&none);
    wr_relief_fini(&still);
    wr_relief_fini(&moved);
    wr_field_free(like);
    return good;
}

/* ---- solids ---- */

/* sqrt(max(0, r^2 - d^2)) of the nearest periodic image, for a sphere of that radius at (u, v). */
static void check_sphere(WrHardGauge *g, const WrRelief *relief, int n, double r, double u,
                         double v)
{
    const double x = n * u - 0.5, y = n * (1.0 - v) - 0.5;
    for (int k = 0; k < n * n; k++) {
        double dx = fabs(k % n - x), dy = fabs(k / n - y);
        dx -= n * floor(dx / n), dy -= n * floor(dy / n);
        dx = fmin(dx, n - dx), dy = fmin(dy, n - dy);
        const double rest = r * r - dx * dx - dy * dy, d = sqrt(dx * dx + dy * dy);
        /* a texel on the rim may show a part of the sphere */
        if (rest < 0.0 && d < r + 0.75) continue;
        wr_hard_near(g, WR_HARD_FLOAT, (double)wr_field_get(relief->heights, k % n, k / n),
                     rest > 0.0 ? sqrt(rest) / r : 0.0);
    }
}

static bool hc79(WrHardGauge *g, WrError *err)
{
    static const double spheres[][3] = { { 20, 0.5, 0.5 }, { 0.3, 0.52, 0.27 }, { 12, 0, 0 },
                                         { 31, 0.3, 0.9 }, { 200, 0.4, 0.6 },   { 9, 7.25, -3.5 } };
    Values values;
    if (!values_of(&values, "solid", "sphere", err)) return false;
    WrField *like = blank(64, 64);
    bool good = true;
    for (int k = 0; k < 6 && good; k++) {
        WrRelief relief = { NULL, NULL };
        param(&values, "radius")->number[0] = spheres[k][0];
        memcpy(param(&values, "at")->number, spheres[k] + 1, 2 * sizeof(double));
        good = make(&values, like, NULL, &relief, err);
        if (good) check_sphere(g, &relief, 64, spheres[k][0], spheres[k][1], spheres[k][2]);
        wr_relief_fini(&relief);
    }
    WrRelief refused = { NULL, NULL };
    param(&values, "radius")->number[0] = 0.0;
    const bool made = make(&values, like, NULL, &refused, NULL);
    wr_hard_off(g, WR_HARD_FLOAT, made ? 1.0 : 0.0);
    wr_relief_fini(&refused);
    wr_field_free(like);
    return good;
}

/* Boxes side by side and overlapping, with tops in one plane: equal heights wherever they meet. */
static bool hc80(WrHardGauge *g, WrError *err)
{
    Values values;
    if (!values_of(&values, "solid", "box", err)) return false;
    WrField *like = blank(150, 100);
    for (int k = 0; k < 2; k++) param(&values, "size")->number[k] = 30;
    param(&values, "across")->number[0] = 9;
    param(&values, "rows")->number[0] = 7;
    param(&values, "stagger")->number[0] = 0.37;
    param(&values, "jitter")->number[0] = 5;
    WrRelief first = { NULL, NULL };
    bool good = make(&values, like, NULL, &first, err);
    for (int threads = 1; threads <= 3 && good; threads++) {
        WrPool *pool = wr_pool_new(threads);
        WrRelief again = { NULL, NULL };
        good = make(&values, like, pool, &again, err);
        if (good)
            wr_hard_holds(g, WR_HARD_FLOAT,
                          wr_hard_equal(first.heights, again.heights) &&
                              wr_hard_equal(first.cover, again.cover));
        wr_relief_fini(&again);
        wr_pool_free(pool);
    }
    for (int k = 0; k < 150 * 100 && good; k++) { /* between the boxes' tops and the ground */
        const float f = wr_field_get(first.heights, k % 150, k / 150);
        wr_hard_holds(g, WR_HARD_FLOAT, f == 0.0f || fabsf(f - 1.0f) < 1e-6f);
    }
    wr_relief_fini(&first);
    wr_field_free(like);
    return good;
}

/* ---- history ---- */

static bool hc81(WrHardGauge *g, WrError *err)
{
    enum { STROKES = 1000, EVERY = 20 };
    WrHash hashes[STROKES / EVERY + 1];
    WrDocument *document = wr_document_new();
    WrField *heights = wr_field_new(128, 96, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    if (!heights) {
        wr_document_free(document);
        return false;
    }
    wr_document_start_over(document, heights);
    WrHistory *history = wr_history_new(document, 0, WR_HISTORY_BUDGET);
    hashes[0] = wr_field_hash(wr_document_field(document));
    for (int k = 1; k <= STROKES; k++) {
        WrBrush brush = wr_brush_default();
        brush.radius = 12 * wr_hard_random(g);
        brush.strength = wr_hard_random(g) - 0.4;
        WrStroke *stroke = wr_stroke_new(document->layers[0].heights, &brush);
        for (int p = 0; p < 2; p++)
            wr_stroke_add(stroke, (WrSample){ .u = wr_hard_random(g),
                                              .v = wr_hard_random(g),
                                              .pressure = wr_hard_random(g) });
        wr_stroke_free(stroke);
        wr_history_push(history, document, "stroke", NULL, (uint64_t)k);
        if (k % EVERY == 0) hashes[k / EVERY] = wr_field_hash(wr_document_field(document));
    }
    for (int k = 2 * STROKES; k >= 0; k -= EVERY) { /* back to the first, and forward again */
        const int state = k > STROKES ? k - STROKES : STROKES - k;
        WrDocument *there = wr_history_go(history, state);
        wr_hard_holds(
            g, WR_HARD_FLOAT,
            wr_hash_equal(wr_field_hash(wr_document_field(there)), hashes[state / EVERY]));
        wr_document_free(there);
    }
    wr_history_free(history);
    wr_document_free(document);
    return true;
}

#define ROW(number, situation, rule, u, in_float, script)                                          \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_PAINT, .what = situation, .holds = rule, .unit = u, \
        .bound = { in_float, NAN }, .measure = hc##number, .scene = script                         \
    }
static const WrHardCase stamps[] = {
    ROW(78, "text over the edges, wider than the table, or empty",
        "it wraps as if rolled, to the bit; empty covers nothing", "violations", 0,
        "table 64x48\ntext \"Mg\\\\nW\" size=60 at=1,1\nsurface plane\nbump height=0.05"),
    ROW(79, "spheres of radius 0, under a texel, over edges, larger than the table",
        "their square root; radius 0 is refused", "height", 1e-6,
        "table 64x64\nsolid sphere radius=31 at=0,0\nsurface plane\nbump height=0.2"),
    ROW(80, "solids of equal and coplanar heights", "the same bytes on any number of threads",
        "violations", 0,
        "table 150x100\nsolid box size=30,30,30 across=4 rows=3 jitter=9\nsurface plane\nbump "
        "height=0.05"),
};
WR_HARD_LIST(stamp, stamps);

static const WrHardCase undone[] = {
    ROW(81, "a thousand strokes undone and done again", "every state comes back to the bit",
        "violations", 0, NULL),
};
WR_HARD_LIST(undo, undone);
