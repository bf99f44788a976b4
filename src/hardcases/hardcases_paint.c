/* Hard cases of dabs and strokes. Heights are floats; their changes are computed in double. */
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "brush/brush.h"
#include "document/document.h"
#include "document/history.h"
#include "field/field.h"
#include "field/ops.h"
#include "generate/generator.h"
#include "hardcases/hardcases_internal.h"
#include "image/font.h"
#include "render/plan/plan.h"
#include "render/tessellation/dice.h"
#include "render/visibility/view.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* ---- Hard cases of rasterizing into a table, and of going back and forth in its history ---- */

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
static void same_rolled(WrHardMeasurement *g, const WrRelief *still, const WrRelief *moved, int w,
                        int h)
{
    WrField *heights = wr_hard_rolled(still->heights, w / 2, h / 2);
    WrField *cover = wr_hard_rolled(still->cover, w / 2, h / 2);
    wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_equal(heights, moved->heights));
    wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_equal(cover, moved->cover));
    wr_field_free(heights);
    wr_field_free(cover);
}

static bool hc78(WrHardMeasurement *g, WrError *err)
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
static void check_sphere(WrHardMeasurement *g, const WrRelief *relief, int n, double r, double u,
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

static bool hc79(WrHardMeasurement *g, WrError *err)
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
    wr_hard_record_error(g, WR_HARD_FLOAT, made ? 1.0 : 0.0);
    wr_relief_fini(&refused);
    wr_field_free(like);
    return good;
}

/* Boxes side by side and overlapping, with tops in one plane: equal heights wherever they meet. */
static bool hc80(WrHardMeasurement *g, WrError *err)
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

static bool hc81(WrHardMeasurement *g, WrError *err)
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
        wr_stroke_finish(stroke);
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

/* ---- Hard cases of displaced surfaces ---- */

#define SIDE 72 /* pixels */
#define CASES 3

static WrScene *displaced_of(int k, double height, double dice)
{
    static const WrSurfaceKind kinds[CASES] = { WR_SURFACE_cube, WR_SURFACE_sphere,
                                                WR_SURFACE_torus };
    WrScene *scene = wr_scene_new();
    const WrShape shape = wr_hard_shape(kinds[k]);
    wr_scene_set_shape(scene, &shape);
    scene->displaced = true;
    scene->height = height;
    scene->dials.dice = dice;
    scene->replicate_u = k == 1 ? 1.43 : 2; /* the sphere's seam is not periodic */
    return scene;
}

/* An edge of a facet by the positions of its ends; way: its direction. */
typedef struct Edge {
    float end[2][3];
    int way;
} Edge;

static int compare_edges(const void *a, const void *b)
{
    return memcmp(((const Edge *)a)->end, ((const Edge *)b)->end, sizeof((const Edge *)a)->end);
}

static Edge edge_of(const float *from, const float *to)
{
    Edge edge = { .way = memcmp(from, to, 3 * sizeof *from) < 0 ? 1 : -1 };
    memcpy(edge.end[edge.way < 0], from, 3 * sizeof *from);
    memcpy(edge.end[edge.way > 0], to, 3 * sizeof *to);
    return edge;
}

/* Number of facet edges that do not occur equally often in both directions: each is a crack. */
static int cracks(const WrTriangles *t)
{
    const int32_t most = 3 * t->triangle_count;
    Edge *edges = wr_alloc((size_t)most, sizeof *edges);
    int32_t count = 0;
    int open = 0;
    for (int32_t i = 0; i < most; i++) {
        const int32_t *c = t->triangles[i / 3].corner;
        const float *from = t->corners[c[i % 3]].p, *to = t->corners[c[(i + 1) % 3]].p;
        if (memcmp(from, to, 3 * sizeof *from) != 0) edges[count++] = edge_of(from, to);
    }
    qsort(edges, (size_t)count, sizeof *edges, compare_edges);
    for (int32_t i = 0, end; i < count; i = end) {
        int sum = 0;
        for (end = i; end < count && compare_edges(&edges[i], &edges[end]) == 0; end++)
            sum += edges[end].way;
        open += sum != 0;
    }
    wr_free(edges);
    return open;
}

static bool look_for_cracks(WrHardMeasurement *g, const WrFrameRequest *request, WrError *err)
{
    const WrScene *scene = request->scene;
    WrHardShot shot;
    WrView view = { 0 };
    WrDice made = { 0 };
    const WrDiceRequest ask = { .scene = scene,
                                .field = request->field,
                                .view = &view,
                                .epsilon = scene->dials.dice,
                                .pool = g->pool };
    if (!wr_hard_shoot(g, request, &shot, err)) return false;
    const bool good = wr_view_init(&view, scene, wr_shape_radius(&scene->shape), shot.frame.plan,
                                   request->turn_deg, SIDE, SIDE, err) &&
                      wr_dice_update(&made, &ask, err);
    if (good) wr_hard_record_error(g, WR_HARD_FLOAT, cracks(made.triangles));
    wr_dice_fini(&made);
    wr_view_fini(&view);
    wr_hard_put_away(&shot);
    return good;
}

static bool hc124(WrHardMeasurement *g, WrError *err)
{
    static const double rates[] = { 16, 4, 1.7, 0.5 };
    WrField *field = wr_hard_random_table(g, 11, 7, WR_WRAP_PERIODIC);
    bool good = true;
    for (int k = 0; k < 4 * CASES && good; k++) {
        WrScene *scene = displaced_of(k % CASES, 0.13, rates[k / CASES]);
        WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIDE, .height = SIDE, .turn_deg = 22
        };
        good = look_for_cracks(g, &request, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* All values are finite, by facets and by the reference. If the number of facets reaches its limit, that is
   reported, and the second arithmetic, which uses the same facets, is skipped. */
static bool ends(WrHardMeasurement *g, const WrFrameRequest *request, bool endless, WrError *err)
{
    WrReference truth = { 0 };
    bool good = wr_hard_refer(g, request, 1, &truth, err);
    if (good) wr_hard_record_error(g, WR_HARD_DOUBLE, (double)wr_hard_wild_reference(&truth));
    for (int way = 0; way < (endless ? 1 : WR_HARD_WAYS) && good; way++) {
        const WrHardPrecision precision = way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
        WrHardShot shot;
        good = wr_hard_shoot_by(g, request, (WrHardWay)way, &shot, err);
        if (!good) break;
        const char *why = shot.frame.plan->rows[WR_EFFECT_DISPLACED].reason;
        wr_hard_record_error(g, precision, (double)wr_hard_wild(&shot));
        wr_hard_holds(g, precision, !endless || strstr(why, "as many as there may be"));
        wr_hard_put_away(&shot);
    }
    wr_reference_fini(&truth);
    return good;
}

static bool hc125(WrHardMeasurement *g, WrError *err)
{
    WrField *level = wr_field_new(4, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 1, err);
    WrField *rough = wr_hard_random_table(g, 31, 17, WR_WRAP_PERIODIC);
    bool good = level != NULL;
    for (int k = 0; k < 2 && good; k++) {
        WrScene *scene = displaced_of(1, k == 0 ? -1 : 1e6, 0.5);
        scene->shape.value[0] = 1;
        scene->displaced = false;
        wr_scene_hold_camera(scene, scene, 1); /* the base's camera: from inside, not from afar */
        scene->displaced = true;
        const WrFrameRequest request = {
            .field = k == 0 ? level : rough, .scene = scene, .width = 9, .height = 9
        };
        good = ends(g, &request, k == 1, err);
        wr_scene_free(scene);
    }
    wr_field_free(level);
    wr_field_free(rough);
    return good;
}

#define DISPLACED "table 11x7\ndab 0.3,0.4 radius=3 strength=1\nreplicate 1.43,1\n"
static const WrHardCase rows[] = {
    { .id = "HC124",
      .subject = WR_HARD_RENDER,
      .what = "edges of a displaced cube, poles and an open seam of a displaced sphere",
      .holds = "each edge of a facet is that of another the other way round, at four rates",
      .unit = "edges without",
      .bound = { 0, NAN },
      .measure = hc124,
      .scene = DISPLACED "surface sphere\nbump height=0.2 displaced=on" },
    { .id = "HC125",
      .subject = WR_HARD_RENDER,
      .what = "a sphere displaced to its middle, and by a million",
      .holds = "every value is finite; facets stop at their limit, which is reported",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = hc125,
      .scene = DISPLACED "surface sphere\nbump height=1e6 displaced=on" },
};
WR_HARD_LIST(raised, rows);

static WrBrush brush_of(double radius, double hardness, double strength)
{
    WrBrush brush = wr_brush_default();
    brush.radius = radius;
    brush.hardness = hardness;
    brush.strength = strength;
    return brush;
}

static WrField *torus(int w, int h)
{
    return wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
}

static void draw(WrField *field, const WrBrush *brush, const WrSample *samples, int count)
{
    WrStroke *stroke = wr_stroke_new(field, brush);
    for (int k = 0; k < count; k++) wr_stroke_add(stroke, samples[k]);
    wr_stroke_finish(stroke);
}

static WrSample at(double u, double v, double pressure)
{
    return (WrSample){ .u = u, .v = v, .pressure = pressure };
}

/* Compares two tables: largest difference of heights. */
static void compare(WrHardMeasurement *g, const WrField *a, const WrField *b)
{
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++)
            wr_hard_near(g, WR_HARD_FLOAT, (double)wr_field_get(a, i, j),
                         (double)wr_field_get(b, i, j));
}

static bool hc69(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double radii[] = { 0.3, 1.5, 10, 31.9, 32, 50 };
    for (int r = 0; r < 6; r++) {
        WrField *corner = torus(64, 64), *middle = torus(64, 64);
        const WrBrush brush = brush_of(radii[r], 0.3, 0.7);
        wr_brush_dab(corner, &brush, 0, 0);
        wr_brush_dab(middle, &brush, 0.5, 0.5);
        WrField *rolled = wr_hard_rolled(middle, 32, 32);
        compare(g, corner, rolled);
        wr_field_free(corner);
        wr_field_free(middle);
        wr_field_free(rolled);
    }
    return true;
}

static bool hc70(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double radii[] = { 200, 1e6, 1e9, INFINITY };
    for (int r = 0; r < 4; r++) {
        WrField *field = torus(90, 64);
        const WrBrush brush = brush_of(radii[r], 1, 0.25);
        wr_brush_dab(field, &brush, 10.5 / 90, 1 - 5.5 / 64);
        for (int k = 0; k < 90 * 64; k++)
            wr_hard_near(g, WR_HARD_FLOAT, (double)wr_field_get(field, k % 90, k / 90), 0.25);
        wr_field_free(field);
    }
    return true;
}

static bool hc71(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double none[] = { 0, -1, NAN, -INFINITY };
    for (int k = 0; k < 4; k++) {
        WrField *field = wr_hard_random_table(g, 50, 40, WR_WRAP_PERIODIC),
                *was = wr_field_share(field);
        const WrBrush brush = brush_of(none[k], 0.5, 1);
        wr_brush_dab(field, &brush, 0.4, 0.4);
        const WrSample path[] = { at(0.1, 0.1, 1), at(0.5, 0.6, 1) };
        draw(field, &brush, path, 2);
        wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_equal(field, was));
        wr_field_free(field);
        wr_field_free(was);
    }
    for (int k = 0; k < 4; k++) { /* strength 0, and above the maximum; and the limits of float */
        static const double strengths[] = { 0, NAN, INFINITY, -INFINITY };
        WrField *field = wr_hard_random_table(g, 50, 40, WR_WRAP_PERIODIC),
                *was = wr_field_share(field);
        const WrBrush brush = brush_of(3, 1, strengths[k]);
        wr_brush_dab(field, &brush, 0.5, 0.5);
        const double got = (double)wr_field_get(field, 25, 20);
        const double end = k == 2 ? (double)FLT_MAX : -(double)FLT_MAX;
        wr_hard_holds(g, WR_HARD_FLOAT, k < 2 ? wr_hard_equal(field, was) : got == end);
        wr_field_free(field);
        wr_field_free(was);
    }
    WrField *field = torus(50, 40);
    const WrBrush brush = brush_of(0.3, 0.5, 1);
    wr_brush_dab(field, &brush, 0.999, 0.001);
    for (int k = 0; k < 50 * 40; k++)
        wr_hard_holds(g, WR_HARD_FLOAT,
                      wr_field_get(field, k % 50, k / 50) == (k == 50 * 40 - 1 ? 1.0f : 0.0f));
    wr_field_free(field);
    return true;
}

static bool hc72(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double radii[] = { 0.4, 3, 30 };
    for (int r = 0; r < 3; r++) {
        WrField *dab = wr_hard_random_table(g, 80, 80, WR_WRAP_PERIODIC),
                *stroke = wr_field_share(dab);
        const WrBrush brush = brush_of(radii[r], 0.2, 0.5);
        WrSample path[100];
        for (int k = 0; k < 100; k++) path[k] = at(0.31, 0.77, 1);
        wr_brush_dab(dab, &brush, 0.31, 0.77);
        draw(stroke, &brush, path, 100);
        compare(g, dab, stroke);
        wr_field_free(dab);
        wr_field_free(stroke);
    }
    return true;
}

static bool hc73(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    const WrSample across[] = { at(0.9375, 0.875, 1), at(0.0625, 0.125, 1), at(0.25, 0.0, 1) };
    const WrSample inside[] = { at(0.4375, 0.375, 1), at(0.5625, 0.625, 1), at(0.75, 0.5, 1) };
    for (int thin = 0; thin < 2; thin++) {
        WrField *seam = torus(128, 64), *middle = torus(128, 64);
        const WrBrush brush = brush_of(thin ? 0.5 : 4.5, 0.4, 1);
        draw(seam, &brush, across, 3);
        draw(middle, &brush, inside, 3);
        WrField *rolled = wr_hard_rolled(middle, 64, 32);
        compare(g, seam, rolled);
        wr_field_free(seam);
        wr_field_free(middle);
        wr_field_free(rolled);
    }
    return true;
}

static bool hc74(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double pressures[][2] = { { NAN, 0 },      { -3, 0 }, { -INFINITY, 0 },
                                           { INFINITY, 1 }, { 7, 1 },  { 0.5, 0.5 } };
    for (int k = 0; k < 12; k++) { /* with both samples, and with the second alone */
        WrField *wild = wr_hard_random_table(g, 64, 64, WR_WRAP_PERIODIC),
                *tame = wr_field_share(wild);
        const WrBrush brush = brush_of(9, 0.5, 1);
        WrSample a[] = { at(0.5, 0.5, k < 6 ? pressures[k][0] : 0.7),
                         at(0.6, 0.6, pressures[k % 6][0]) };
        WrSample b[] = { at(0.5, 0.5, k < 6 ? pressures[k][1] : 0.7),
                         at(0.6, 0.6, pressures[k % 6][1]) };
        a[0].tilt_x = a[1].tilt_y = k % 2 ? 90 : NAN;
        draw(wild, &brush, a, 2);
        draw(tame, &brush, b, 2);
        compare(g, wild, tame);
        wr_field_free(wild);
        wr_field_free(tame);
    }
    return true;
}

static bool hc75(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double radii[] = { 0.9, 6, 40 };
    static WrSample many[1001];
    for (int r = 0; r < 6; r++) {
        WrField *a = torus(256, 128), *b = torus(256, 128);
        const WrBrush brush = brush_of(radii[r / 2], 0.3, 0.8);
        for (int k = 0; k <= 1000; k++)
            many[k] = at(0.125 + 0.375 * k / 1000, r % 2 ? 0.2 + 0.3 * k / 1000 : 0.45, 0.75);
        const WrSample two[] = { many[0], many[1000] };
        draw(a, &brush, many, 1001);
        draw(b, &brush, two, 2);
        compare(g, a, b);
        wr_field_free(a);
        wr_field_free(b);
    }
    return true;
}

/* A million dabs of 2^-10 are exactly 976.5625; dabs of FLT_MAX / 10 stop at FLT_MAX. Relative deviation. */
static bool hc76(WrHardMeasurement *g, WrError *err)
{
    (void)err;
    static const double strengths[] = { 0x1p-10, (double)FLT_MAX / 10 };
    for (int s = 0; s < 2; s++) {
        WrField *field = torus(8, 8);
        const WrBrush brush = brush_of(0.5, 1, strengths[s]);
        for (int k = 0; k < 1000000; k++) wr_brush_dab(field, &brush, 0.3, 0.3);
        const double got = (double)wr_field_get(field, 2, 5);
        wr_hard_near(g, WR_HARD_FLOAT, got / (s ? (double)FLT_MAX : 1e6 * 0x1p-10), 1.0);
        wr_field_free(field);
    }
    return true;
}

static double mean_of(const WrField *field)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    double sum = 0.0;
    for (int k = 0; k < w * h; k++) sum += (double)wr_field_get(field, k % w, k / w);
    return sum / (w * h);
}

/* Change of the mean by one pass, and the excess over the previous range. */
static void check_pass(WrHardMeasurement *g, const WrField *was, const WrField *is)
{
    float low, high, low_now, high_now;
    wr_field_range(was, &low, &high);
    wr_field_range(is, &low_now, &high_now);
    wr_hard_near(g, WR_HARD_FLOAT, mean_of(is), mean_of(was));
    wr_hard_record_error(g, WR_HARD_FLOAT, fmax(0.0, (double)high_now - (double)high));
    wr_hard_record_error(g, WR_HARD_FLOAT, fmax(0.0, (double)low - (double)low_now));
}

static bool hc77(WrHardMeasurement *g, WrError *err)
{
    WrField *field = wr_hard_random_table(g, 90, 70, WR_WRAP_PERIODIC);
    const WrOpInfo *blur = wr_op_find("blur");
    WrBrush brush = brush_of(20, 0.5, 1);
    bool good = true;
    for (int k = 0; k < 90 * 70; k++) /* a mean that is not 0 */
        wr_field_set(field, k % 90, k / 90, 0.7f + wr_field_get(field, k % 90, k / 90));
    brush.mode = WR_BRUSH_SMOOTH;
    for (int pass = 0; pass < 24 && good; pass++) {
        const double sigma = 0.5 + 0.25 * pass;
        WrField *next =
            pass % 2 ? wr_op_run(blur, field, &sigma, NULL, err) : wr_field_share(field);
        good = next != NULL;
        if (!good) break;
        if (pass % 2 == 0) {
            const WrSample path[] = { at(0.1, 0.9, 1), at(0.4, 0.5, 1), at(1.1, 0.6, 0.5) };
            draw(next, &brush, path, 3);
        }
        check_pass(g, field, next);
        wr_field_free(field);
        field = next;
    }
    wr_field_free(field);
    return good;
}

static const WrHardCase dabs[] = {
    ROW(69, "a dab on the table's corner", "the dab in the middle, rolled by half, to the bit",
        "height", 0, "table 64x64\ndab 0,0 radius=14 strength=1\nsurface torus\nbump height=0.3"),
    ROW(70, "a dab larger than the table, up to infinitely large", "each texel is touched once",
        "height", 0, "table 64x64\ndab 0.5,0.5 radius=1e6 strength=1\nsurface plane"),
    ROW(71, "radii of 0, below 0, NaN, and a third of a texel; strengths of 0, NaN and infinity",
        "no change; a third of a texel paints one texel, infinite strength gives the largest float",
        "violations", 0, "table 50x40\ndab 0.999,0.001 radius=0.3 strength=1\nsurface plane"),
};
WR_HARD_LIST(dab, dabs);

static const WrHardCase strokes[] = {
    ROW(72, "a stroke that stays in one place", "one dab, to the bit", "height", 0,
        "table 80x80\nstroke radius=12 strength=1 points=0.3,0.7;0.3,0.7;0.3,0.7\nsurface plane"),
    ROW(73, "a stroke across the seam",
        "it takes the short way: equal to the rolled stroke, to the bit", "height", 0,
        "table 128x64\nstroke radius=6 strength=1 points=0.9,0.9;1.1,0.1\nsurface torus\nbump "
        "height=0.3"),
    ROW(74, "a pen's pressure that is NaN, infinite, below 0 or above 1; wild tilts",
        "clamped: the stroke of that pressure, to the bit", "height", 0, NULL),
    ROW(75, "the same stroke in one event and in a thousand", "the same heights", "height", 1e-6,
        "table 256x128\nstroke radius=8 strength=1 points=0.1,0.2;0.9,0.8\nsurface plane"),
    ROW(76, "a million dabs in one place", "their exact sum, or the largest float", "relative", 0,
        NULL),
    ROW(77, "smoothing again and again", "the mean stays and no new extremes appear", "height",
        1e-6, "table 90x70\nnoise perlin cells=12\nadjust blur sigma=3\nsurface plane"),
};
WR_HARD_LIST(stroke, strokes);
