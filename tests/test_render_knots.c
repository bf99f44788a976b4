/* Sparse hits without a depth buffer (sparse_hits.h). A block of one layer is one in which a single triangle covers
   every sample, verified here sample by sample. Interpolated points are on the ray, by the surface's formula in
   double precision. Pictures equal those with separate depth and Newton's method for every sample, for any division,
   edits and threads. */
#include "test.h"
#include "test_render_scenes.h"

#include "render/visibility/sparse_hits.h"
#include "render/pipeline/pipeline.h"

#include <float.h>

enum { W = 301, H = 203 };

typedef struct Seen {
    WrScene *scene;
    WrPlan plan;
    WrView view;
    WrViewMesh mesh;
    WrSparseHits knots;
    const WrKernels *kernels;
    const WrWide *wide;
    WrWideSheet sheet;
    WrPool *pool;
    double turn;
    int finer; /* 2^finer times as many cells */
    /* vertices are displaced from a coarse grid: cells of any orientation, side by side */
    bool crumpled;
    unsigned char count[H + 16]
                       [W + 16]; /* triangles over each sample, up to the ends of the last blocks */
} Seen;

static void crumple(Seen *seen, TestRandom *random)
{
    WrViewMesh *mesh = &seen->mesh;
    for (int i = 0; i < (mesh->mu + 1) * (mesh->mv + 1); i++) {
        const double x = 33 * (i % (mesh->mu + 1)) + 40 * test_random(random);
        const double y = 29 * (i / (mesh->mu + 1)) + 35 * test_random(random);
        mesh->sx[i] = (int32_t)(256 * (x - 50)), mesh->sy[i] = (int32_t)(256 * (y - 50));
        mesh->close[i] = seen->view.perspective ? 0.3f : -3.0f;
        mesh->out[i] = WR_VERTEX_IN;
    }
}

static bool see(Seen *seen, int first, int rows, TestRandom *random)
{
    WrError err = { "" };
    WrScene *scene = seen->scene;
    const WrPlanRequest ask = { .scene = scene, .dials = &scene->dials };
    const WrMeshRequest asked = { .mesh = seen->finer, .newton = -1, .table_w = 64, .table_h = 64 };
    wr_plan_build(&seen->plan, &ask);
    if (!wr_view_init(&seen->view, scene, wr_shape_radius(&scene->shape), &seen->plan, seen->turn,
                      W, H, &err))
        fail_msg("%s", err.text);
    seen->view.cull =
        wr_surfaces[scene->shape.kind]->closed_u && wr_surfaces[scene->shape.kind]->closed_v;
    wr_view_mesh_prepare(&seen->mesh, &scene->shape, &seen->view, &asked, seen->kernels,
                         seen->pool);
    if (seen->crumpled) crumple(seen, random);
    const bool sheet = wr_wide_sheet(scene->shape.kind, &seen->view.shape, &seen->sheet);
    WrSparseHitsRequest how = { .kernels = seen->kernels,
                                .wide = seen->wide,
                                .sheet = sheet ? &seen->sheet : NULL,
                                .newton = seen->mesh.newton,
                                .first = first,
                                .rows = rows };
    how.newton.last = 0x1p-15f;
    return wr_sparse_hits_update(&seen->knots, &seen->mesh, &seen->view, &how, seen->pool);
}

static void forget(Seen *seen)
{
    wr_sparse_hits_fini(&seen->knots);
    wr_view_mesh_fini(&seen->mesh);
    wr_view_fini(&seen->view);
    wr_scene_free(seen->scene);
}

/* ---- layers, counted ---- */

typedef struct Spot {
    int64_t x, y;
} Spot;

static int64_t left_of(Spot a, Spot b, int64_t x, int64_t y)
{
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

static bool owns(Spot a, Spot b)
{
    return b.y < a.y || (b.y == a.y && b.x < a.x);
}

static void count_triangle(Seen *seen, Spot a, Spot b, Spot c)
{
    const int64_t area = left_of(a, b, c.x, c.y);
    if (area == 0 || (area > 0 && seen->view.cull)) return;
    if (area < 0) {
        const Spot swap = b;
        b = c, c = swap;
    }
    const int64_t x0 = a.x < b.x ? a.x < c.x ? a.x : c.x : b.x < c.x ? b.x : c.x;
    const int64_t x1 = a.x > b.x ? a.x > c.x ? a.x : c.x : b.x > c.x ? b.x : c.x;
    const int64_t y0 = a.y < b.y ? a.y < c.y ? a.y : c.y : b.y < c.y ? b.y : c.y;
    const int64_t y1 = a.y > b.y ? a.y > c.y ? a.y : c.y : b.y > c.y ? b.y : c.y;
    for (int64_t y = y0 / 256 - 1; y <= y1 / 256; y++)
        for (int64_t x = x0 / 256 - 1; x <= x1 / 256; x++) {
            if (x < 0 || y < 0 || x >= W + 16 || y >= H + 16) continue;
            const Spot t[4] = { a, b, c, a };
            bool in = true;
            for (int k = 0; k < 3; k++) {
                const int64_t e = left_of(t[k], t[k + 1], 256 * x + 128, 256 * y + 128);
                in = in && (e > 0 || (e == 0 && owns(t[k], t[k + 1])));
            }
            seen->count[y][x] += in;
        }
}

static void count_layers(Seen *seen)
{
    const WrViewMesh *mesh = &seen->mesh;
    memset(seen->count, 0, sizeof seen->count);
    for (int j = 0; j < mesh->mv; j++)
        for (int i = 0; i < mesh->mu; i++) {
            Spot at[4];
            for (int k = 0; k < 4; k++) {
                const int v = (j + k / 2) * (mesh->mu + 1) + i + k % 2;
                at[k] = (Spot){ mesh->sx[v], mesh->sy[v] };
                assert_true(mesh->out[v] != WR_VERTEX_BEHIND);
            }
            count_triangle(seen, at[0], at[1], at[3]);
            count_triangle(seen, at[0], at[3], at[2]);
        }
}

/* ---- interpolated samples ---- */

/* Distance in samples of a point from the ray of (x, y). */
static double off_ray(const Seen *seen, WrVec3 p, double x, double y)
{
    const WrRaysd *rays = &wr_view_grid(&seen->view, 1)->rays_d;
    WrVec3 q, d, step;
    double *const to[3] = { &q.x, &d.x, &step.x };
    for (int c = 0; c < 3; c++) {
        to[0][c] = rays->q0[c] + x * rays->qx[c] + y * rays->qy[c];
        to[1][c] = rays->d0[c] + x * rays->dx[c] + y * rays->dy[c];
        to[2][c] = rays->qx[c];
    }
    const WrVec3 away = v3_sub(p, q), n = v3_unit(d, d);
    return v3_len(v3_sub(away, v3_scale(n, v3_dot(away, n)))) / v3_len(step);
}

static WrSurfacePoint place_at(const Seen *seen, float u, float v)
{
    WrSurfacePoint at;
    wr_surface_at(&seen->view.shape_d, 0, (double)u, (double)v, &at);
    return at;
}

static void expect_same(const char *what, const float *x, const float *y, const float *z, int i,
                        WrVec3 want, double bound)
{
    const WrVec3 got = { (double)x[i], (double)y[i], (double)z[i] };
    if (!(v3_len(v3_sub(got, want)) < bound))
        fail_msg("%s: %.9g %.9g %.9g, not %.9g %.9g %.9g", what, got.x, got.y, got.z, want.x,
                 want.y, want.z);
}

static void check_sheet(const Seen *seen, int x, int y, int count, WrStrip *strip)
{
    const double *by = wr_view_grid(&seen->view, 1)->rays_d.qx;
    const double step = v3_len((WrVec3){ by[0], by[1], by[2] }); /* per sample */
    wr_sparse_hits_row(&seen->knots, seen->wide, x, y, count, 3, strip);
    for (int i = 3; i < 3 + count; i++) {
        const WrSurfacePoint at = place_at(seen, strip->u[i], strip->v[i]);
        const double size = v3_len(at.pu) + v3_len(at.pv);
        const WrVec3 met = { (double)strip->px[i], (double)strip->py[i], (double)strip->pz[i] };
        assert_true(strip->x[i] == (float)(x + i - 3) && strip->y[i] == (float)y);
        assert_true(off_ray(seen, at.p, x + i - 3, y) < 0.01);
        assert_true(off_ray(seen, met, x + i - 3, y) < 0.01);
        expect_same("P", strip->px, strip->py, strip->pz, i, at.p, 0.01 * step);
        expect_same("Pu", strip->pux, strip->puy, strip->puz, i, at.pu, 2e-4 * size);
        expect_same("Pv", strip->pvx, strip->pvy, strip->pvz, i, at.pv, 2e-4 * size);
    }
}

/* A run with any start and end is bit-identical to its blocks one by one. */
static void check_run(const Seen *seen, int x, int y, TestRandom *random, WrStrip *strip)
{
    enum { BEFORE = 9 }; /* existing samples in the strip, unchanged */
    int end = x + 1;
    while (end < W - 8 && end - x < 240 &&
           wr_sparse_hits_at(&seen->knots, end, y) == WR_SPARSE_HITS_SHEET)
        end++;
    const int from = x + (int)(8 * test_random(random)), count = end - from;
    float run[WR_KNOT_NUMBERS][WR_SPAN];
    float *const of[WR_KNOT_NUMBERS] = { strip->u,   strip->v,   strip->px,  strip->py,
                                         strip->pz,  strip->pux, strip->puy, strip->puz,
                                         strip->pvx, strip->pvy, strip->pvz };
    if (count <= 0) return;
    for (int k = 0; k < WR_KNOT_NUMBERS; k++)
        for (int i = 0; i < BEFORE; i++) of[k][i] = 77;
    wr_sparse_hits_row(&seen->knots, seen->wide, from, y, count, BEFORE, strip);
    for (int k = 0; k < WR_KNOT_NUMBERS; k++)
        for (int i = 0; i < BEFORE; i++) assert_true(of[k][i] == 77);
    for (int k = 0; k < WR_KNOT_NUMBERS; k++)
        memcpy(run[k], of[k] + BEFORE, (size_t)count * sizeof(float));
    for (int i = 0; i < count; i++) {
        wr_sparse_hits_row(&seen->knots, seen->wide, from + i, y, 1, 0, strip);
        for (int k = 0; k < WR_KNOT_NUMBERS; k++)
            if (memcmp(&run[k][i], of[k], sizeof(float)) != 0)
                fail_msg("number %d of sample %d of a run of %d: %g, not %g", k, i, count,
                         (double)run[k][i], (double)of[k][0]);
    }
}

/* Counts of blocks by kind. */
typedef struct Kinds {
    int nothing, deep, sheet, between;
} Kinds;

/* Content of the depth tile for a sample. */
static void check_tile(const Seen *seen, const WrDepthTile *tile, int kind, int x, int y)
{
    const size_t at = (size_t)(y - tile->y) * (size_t)tile->w + (size_t)(x - tile->x);
    if (kind == WR_SPARSE_HITS_DEPTH) {
        assert_true((tile->close[at] > -FLT_MAX) == (seen->count[y][x] > 0));
        return;
    }
    assert_true(tile->close[at] == (kind >= WR_SPARSE_HITS_BETWEEN ? 0.0f : -FLT_MAX));
    if (kind < WR_SPARSE_HITS_BETWEEN || seen->crumpled) return;
    const double off = off_ray(seen, place_at(seen, tile->u[at], tile->v[at]).p, x, y);
    if (!(off < 1))
        fail_msg("%s: guess %d, %d is %g samples off", wr_surfaces[seen->scene->shape.kind]->name,
                 x, y, off);
}

static void check_block(const Seen *seen, const WrDepthTile *tile, int x, int y, Kinds *kinds,
                        WrStrip *strip)
{
    const int kind = wr_sparse_hits_at(&seen->knots, x, y), x1 = x + 8 < W ? x + 8 : W;
    const int layers = kind == WR_SPARSE_HITS_NOTHING ? 0 : 1;
    kinds->nothing += kind == WR_SPARSE_HITS_NOTHING, kinds->deep += kind == WR_SPARSE_HITS_DEPTH;
    kinds->sheet += kind == WR_SPARSE_HITS_SHEET, kinds->between += kind >= WR_SPARSE_HITS_BETWEEN;
    for (int j = y; j < y + 8 && j < H; j++) {
        for (int i = x; i < x1 && !seen->crumpled; i++) check_tile(seen, tile, kind, i, j);
        if (kind == WR_SPARSE_HITS_SHEET && !seen->crumpled) check_sheet(seen, x, j, x1 - x, strip);
    }
    for (int j = y; j < y + 8 && kind != WR_SPARSE_HITS_DEPTH; j++)
        for (int i = x; i < x + 8; i++)
            if (seen->count[j][i] != layers)
                fail_msg("%s: %d triangles cover sample %d, %d of a block of kind %d",
                         wr_surfaces[seen->scene->shape.kind]->name, seen->count[j][i], i, j, kind);
}

static WrScene *some_scene(TestRandom *random, int k)
{
    static const char *const surfaces[] = { "torus", "bezier", "ribbon", "bent" };
    WrScene *scene = scene_of(surfaces[k % 4]);
    scene->dials.arithmetic = WR_ARITHMETIC_FAST;
    scene->camera.orthographic = k % 3 != 0;
    scene->camera.size = (k % 3 == 1 ? 1.2 : 0.4) + test_random(random);
    if (k % 4 == 1)
        for (int i = 0; i < 48; i++) scene->shape.value[i] += 0.2 * test_random(random);
    return scene;
}

static void look_at(Seen *seen, int first, int rows, TestRandom *random, Kinds *kinds,
                    WrStrip *strip)
{
    enum { X = 5, Y = 3, WIDE = W - 9 }; /* a tile that starts within blocks */
    enum { ROOM = W * H + WR_WALK_PAD };
    static float close[ROOM], u[ROOM], v[ROOM];
    WrDepthTile tile = { .x = X,
                         .y = first + Y,
                         .w = WIDE,
                         .h = rows - 2 * Y,
                         .close = close,
                         .u = u,
                         .v = v,
                         .k = 1,
                         .kernels = seen->kernels };
    wr_sparse_hits_report(&seen->knots, &tile);
    wr_view_mesh_raster(&seen->mesh, &seen->view, &tile);
    wr_sparse_hits_fill(&seen->knots, seen->wide, &tile);
    for (int y = first - first % 8 + 8; y + 8 < first + rows - Y; y += 8) {
        for (int x = 8; x + 8 < X + WIDE; x += 8) check_block(seen, &tile, x, y, kinds, strip);
        const int x = 8 * (int)(30 * test_random(random));
        if (wr_sparse_hits_at(&seen->knots, x, y) == WR_SPARSE_HITS_SHEET)
            check_run(seen, x, y + (int)(8 * test_random(random)), random, strip);
    }
}

/* Both sets, many views, and bands. */
static void blocks_show_what_they_are_told_to(void **state)
{
    (void)state;
    static const char *const names[] = { "v3", "v4" };
    Seen *seen = wr_alloc(1, sizeof *seen);
    WrStrip *strip = wr_alloc(1, sizeof *strip);
    seen->pool = wr_pool_new(2);
    for (int s = 0; s < 2; s++) {
        TestRandom random = { 7 };
        Kinds kinds = { 0 };
        seen->kernels = wr_kernels_get(names[s], true, NULL);
        seen->wide = seen->kernels ? wr_wide_of(seen->kernels) : NULL;
        for (int k = 0; k < 24 && seen->wide; k++) {
            const int first = k % 2 ? 61 : 0, rows = k % 2 ? 77 : H;
            seen->scene = some_scene(&random, k);
            seen->turn = 360 * test_random(&random);
            seen->crumpled = k % 5 == 2;
            seen->finer = k % 5 == 1 ? -2 : seen->crumpled ? -5 : 0;
            seen->mesh = (WrViewMesh){ .mu = 0 };
            assert_true(see(seen, first, rows, &random));
            assert_int_equal(seen->knots.top, first / WR_KNOT - WR_SPARSE_HITS_AROUND);
            count_layers(seen);
            look_at(seen, first, rows, &random, &kinds, strip);
            forget(seen);
        }
        if (!seen->wide) continue;
        assert_in_range(kinds.nothing, 150, 100000);
        assert_in_range(kinds.deep, 150, 100000);
        assert_in_range(kinds.sheet, 150, 100000);
        assert_in_range(kinds.between, 150, 100000);
    }
    wr_pool_free(seen->pool);
    wr_free(strip);
    wr_free(seen);
}

/* ---- pictures ---- */

/* The same pixels are covered as without sparse hits, which a fixed number of steps disables, with the same look. */
static void pictures_are_those_without(void **state)
{
    (void)state;
    TestRandom random = { 19 };
    WrField *field = bumpy_field(64, 48);
    for (int k = 0; k < 16; k++) {
        WrScene *scene = some_scene(&random, k), *plain = wr_scene_clone(scene);
        scene->replicate_u = scene->replicate_v = plain->replicate_u = plain->replicate_v = 1;
        plain->dials.newton = 4;
        const int w = k % 4 < 2 ? 235 : 117; /* row by row, and several rows at once */
        Shot a = shoot(scene, field, w, 190, 2, "auto", false);
        Shot b = shoot(plain, field, w, 190, 1, "auto", false);
        assert_int_equal(a.frame.covered, b.frame.covered);
        for (int i = 0; i < w * 190; i++)
            assert_true(a.frame.rgba[4 * i + 3] == b.frame.rgba[4 * i + 3]);
        if (worst_difference(&a, &b) > 0.004f)
            fail_msg("case %d: %g", k, (double)worst_difference(&a, &b));
        put_away(&a), put_away(&b);
        wr_scene_free(scene), wr_scene_free(plain);
    }
    wr_field_free(field);
}

/* Views drawn again, partly requested, or partly affected by an edit: bit-identical to the whole. */
static void parts_have_the_bits_of_the_whole(void **state)
{
    (void)state;
    TestRandom random = { 3 };
    WrError err = { "" };
    WrField *field = random_field(40, 30, 1);
    for (int k = 0; k < 6; k++) {
        WrScene *scene = some_scene(&random, k);
        const int w = 187, h = 121, across = (w + 7) / 8;
        unsigned char only[24 * 16];
        if (k == 2 || k == 5) scene->dials.aa = WR_AA_SUPERSAMPLE, scene->dials.samples = 2;
        Shot whole = shoot(scene, field, w, h, 7, "auto", false);
        Shot part = shoot(scene, field, w, h, 1, "auto", false);
        assert_true(same_picture(&whole, &part));
        memset(part.frame.rgba, 0, frame_bytes(&part.frame));
        for (int i = 0; i < 24 * 16; i++) only[i] = test_random(&random) < 0.3;
        WrFrameRequest request = {
            .field = field, .scene = scene, .width = w, .height = h, .turn_deg = 15, .only = only
        };
        if (!wr_renderer_frame(part.renderer, &request, &part.frame, &err))
            fail_msg("%s", err.text);
        for (int i = 0; i < w * h; i++)
            if (only[i / w / 8 * across + i % w / 8])
                assert_memory_equal(part.frame.rgba + 4 * i, whole.frame.rgba + 4 * i, 16);
        put_away(&whole), put_away(&part);
        expect_refreshed(scene, k);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_show_what_they_are_told_to),
        cmocka_unit_test(pictures_are_those_without),
        cmocka_unit_test(parts_have_the_bits_of_the_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
