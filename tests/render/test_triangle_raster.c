/* Triangle rasterisation into tiles, by every instruction set: the samples by exact integer arithmetic, depth and
   parameters by double precision; no sample twice and none missing between neighbours (HC85). */
#include "test.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "render/kernels/kern.h"
#include "render/visibility/raster.h"
#include "scene/scene.h"

#include <float.h>

enum { W = 83, H = 41, ROOM = W * H + WR_WALK_PAD };

typedef struct Sheet {
    float close[ROOM], u[ROOM], v[ROOM];
    WrDepthTile tile;
} Sheet;

static Sheet *sheet_new(const WrKernels *kernels, int x, int y)
{
    Sheet *sheet = wr_alloc(1, sizeof *sheet);
    sheet->tile = (WrDepthTile){ .x = x,
                                 .y = y,
                                 .w = W,
                                 .h = H,
                                 .close = sheet->close,
                                 .u = sheet->u,
                                 .v = sheet->v,
                                 .kernels = kernels };
    for (int i = 0; i < ROOM; i++) sheet->close[i] = -FLT_MAX, sheet->u[i] = 7, sheet->v[i] = 9;
    return sheet;
}

static WrRasterVertex some_vertex(TestRandom *random, const WrDepthTile *tile, double reach)
{
    const double x = tile->x + W * test_random(random), y = tile->y + H * test_random(random);
    return (WrRasterVertex){ (int32_t)(256 * x + reach * (test_random(random) - 0.5)),
                             (int32_t)(256 * y + reach * (test_random(random) - 0.5)),
                             (float)(0.2 + test_random(random)), (float)test_random(random),
                             (float)test_random(random) };
}

/* Twice the area left of a -> b -> p. */
static int64_t left_of(const WrRasterVertex *a, const WrRasterVertex *b, int64_t x, int64_t y)
{
    return ((int64_t)b->x - a->x) * (y - a->y) - ((int64_t)b->y - a->y) * (x - a->x);
}

/* True if a sample on the edge belongs to the triangle. Rows run down; the inside is on the right of an edge that
   goes up. */
static bool owns(const WrRasterVertex *a, const WrRasterVertex *b)
{
    return b->y < a->y || (b->y == a->y && b->x < a->x);
}

static void check_sample(const WrRasterVertex t[3], const Sheet *sheet, int x, int y,
                         bool perspective)
{
    const int64_t px = ((int64_t)sheet->tile.x + x) * 256 + 128;
    const int64_t py = ((int64_t)sheet->tile.y + y) * 256 + 128;
    const int64_t area = left_of(&t[0], &t[1], t[2].x, t[2].y);
    const int at = y * W + x;
    double share[3];
    bool in = true;
    for (int k = 0; k < 3; k++) {
        const WrRasterVertex *a = &t[(k + 1) % 3], *b = &t[(k + 2) % 3];
        const int64_t e = left_of(a, b, px, py);
        in = in && (e > 0 || (e == 0 && owns(a, b)));
        share[k] = (double)e / (double)area;
    }
    assert_int_equal(sheet->close[at] > -FLT_MAX, in);
    if (!in) {
        assert_true(sheet->u[at] == 7 && sheet->v[at] == 9);
        return;
    }
    double near = 0, u = 0, v = 0;
    for (int k = 0; k < 3; k++) {
        const double by = share[k] * (perspective ? (double)t[k].close : 1.0);
        near += share[k] * (double)t[k].close;
        u += by * (double)t[k].u;
        v += by * (double)t[k].v;
    }
    const double depth = perspective ? near : 1.0;
    /* an edge that does not own its samples is one unit further inside */
    const double owned = 2.0 / (double)area;
    assert_near((double)sheet->close[at], near, 4e-6 + owned);
    assert_near((double)sheet->u[at], u / depth, 4e-5 + 8 * owned);
    assert_near((double)sheet->v[at], v / depth, 4e-5 + 8 * owned);
}

static void check_triangle(const WrKernels *kernels, TestRandom *random, double reach, bool near)
{
    const int x = (int)(4000 * test_random(random)), y = (int)(4000 * test_random(random));
    Sheet *sheet = sheet_new(kernels, x, y);
    WrView view = { .samples = 1, .perspective = near };
    WrRasterVertex t[3];
    for (int k = 0; k < 3; k++) t[k] = some_vertex(random, &sheet->tile, reach);
    wr_raster_triangle(&view, t[0], t[1], t[2], &sheet->tile);
    const int64_t area = left_of(&t[0], &t[1], t[2].x, t[2].y);
    if (area < 0) {
        const WrRasterVertex swap = t[1];
        t[1] = t[2], t[2] = swap;
    }
    for (int i = 0; i < W * H && area != 0; i++) check_sample(t, sheet, i % W, i / W, near);
    for (int i = W * H; i < ROOM; i++) assert_true(sheet->close[i] == -FLT_MAX);
    wr_free(sheet);
}

static const struct {
    const char *name;
    bool fast;
} sets[] = { { "ref", false }, { "v1", false }, { "v2", false }, { "v3", false },
             { "v4", false },  { "v3", true },  { "v4", true } };

/* Small triangles use vectors, those of some hundred samples scalar code: both are tested. */
static void triangles_cover_what_whole_numbers_say(void **state)
{
    (void)state;
    TestRandom random = { 71 };
    for (size_t s = 0; s < sizeof sets / sizeof *sets; s++) {
        const WrKernels *kernels = wr_kernels_get(sets[s].name, sets[s].fast, NULL);
        for (int i = 0; i < 240 && kernels; i++) {
            const double reach = i % 3 == 0 ? 0 : i % 3 == 1 ? 9000 : 90000;
            check_triangle(kernels, &random, reach, i & 1);
        }
    }
}

/* A fan around a point, whose outer points are sometimes on samples: each sample belongs to at most one triangle. */
static void neighbours_share_no_sample(void **state)
{
    (void)state;
    enum { RAYS = 13 };
    const WrKernels *kernels = wr_kernels_get(NULL, false, NULL);
    TestRandom random = { 5 };
    for (int round = 0; round < 60; round++) {
        int times[W * H] = { 0 };
        WrRasterVertex hub = { 128 + 256 * 40, 128 + 256 * 20, 0.5f, 0, 0 }, rim[RAYS];
        const double size = 256 * (2 + 40 * test_random(&random));
        for (int k = 0; k < RAYS; k++) {
            const double a = 2 * WR_PI * k / RAYS, r = size * (0.7 + 0.3 * test_random(&random));
            rim[k] = (WrRasterVertex){ hub.x + 128 * (int32_t)rint(r * cos(a) / 128),
                                       hub.y + 128 * (int32_t)rint(r * sin(a) / 128), 0.5f, 0, 0 };
        }
        for (int k = 0; k < RAYS; k++) {
            Sheet *sheet = sheet_new(kernels, 0, 0);
            WrView view = { .samples = 1 };
            wr_raster_triangle(&view, hub, rim[k], rim[(k + 1) % RAYS], &sheet->tile);
            for (int i = 0; i < W * H; i++) times[i] += sheet->close[i] > -FLT_MAX;
            wr_free(sheet);
        }
        for (int i = 0; i < W * H; i++) assert_true(times[i] <= 1);
        assert_int_equal(times[20 * W + 40], 1);
    }
}

/* For any close eye, only blocks across the near plane have no box, though many vertices are far outside the view. */
static void blocks_keep_their_boxes_near_the_eye(void **state)
{
    (void)state;
    WrError err = { "" };
    WrPool *pool = wr_pool_new(2);
    const WrKernels *kernels = wr_kernels_get(NULL, false, &err);
    for (int k = 0; k < 5; k++) {
        WrScene *scene = wr_scene_new();
        WrPlan plan;
        WrView view;
        WrViewMesh mesh = { .mu = 0 };
        wr_shape_default(WR_SURFACE_torus, &scene->shape);
        scene->camera.fit = false;
        scene->camera.eye = (WrVec3){ 0, 1.5 - 0.2 * k, 0.03 };
        scene->camera.target = (WrVec3){ 0, 0, 0 };
        scene->camera.up = (WrVec3){ 0, 0, 1 };
        const WrPlanRequest ask = { .scene = scene, .dials = &scene->dials };
        wr_plan_build(&plan, &ask);
        assert_true(
            wr_view_init(&view, scene, wr_shape_radius(&scene->shape), &plan, 0, 512, 401, &err));
        const WrMeshRequest asked = { .newton = -1, .table_w = 64, .table_h = 64 };
        wr_view_mesh_prepare(&mesh, &scene->shape, &view, &asked, kernels, pool);
        int out = 0, behind = 0, clipped = 0;
        for (int i = 0; i < (mesh.mu + 1) * (mesh.mv + 1); i++) {
            out += mesh.out[i] == WR_VERTEX_OUT;
            behind += mesh.out[i] == WR_VERTEX_BEHIND;
        }
        for (int i = 0; i < mesh.blocks_u * mesh.blocks_v; i++) clipped += mesh.blocks[i].clipped;
        assert_true(out > 100000);
        if (behind == 0) assert_int_equal(clipped, 0);
        assert_in_range(clipped, 0, mesh.blocks_u * mesh.blocks_v / 40);
        wr_view_mesh_fini(&mesh);
        wr_view_fini(&view);
        wr_scene_free(scene);
    }
    wr_pool_free(pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_cover_what_whole_numbers_say),
        cmocka_unit_test(neighbours_share_no_sample),
        cmocka_unit_test(blocks_keep_their_boxes_near_the_eye),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
