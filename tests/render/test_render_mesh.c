/* Meshes from files: pictures against the sampled surfaces, against the reference, and between instruction sets and
   numbers of threads. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"
#include "mesh_grids.h"

#include "render/kernels/kern.h"
#include "render/reference/reference.h"
#include "surface/projection.h"
#include "surface/triangles.h"

/* ---- meshes ---- */

/* An open surface with a fold, whose parts hide each other. */
static void on_wave(double u, double v, float p[3], float n[3])
{
    const double a = 7 * u;
    p[0] = (float)(sin(a) + 2 * u), p[1] = (float)(2 * v + 0.3 * sin(3 * a)), p[2] = (float)cos(a);
    n[0] = (float)sin(a), n[1] = 0.1f, n[2] = (float)cos(a);
}

static WrScene *scene_with(WrTriangles *mesh)
{
    WrScene *scene = scene_of("mesh");
    wr_scene_set_triangles(scene, mesh, "a.obj", NULL);
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ -60, 0, 30 };
    return scene;
}

/* ---- invariance ---- */

typedef struct Way {
    WrAntialias aa;
    int samples;
    WrSpread spread;
    WrBumpMode bump;
    WrShading shading;
    bool orthographic;
} Way;

static const Way ways[] = {
    { WR_AA_POINT, 1, 0, WR_BUMP_BLINN, WR_SHADING_FLOAT, false },
    { WR_AA_POINT, 1, 0, WR_BUMP_EXACT, WR_SHADING_DOUBLE, true },
    { WR_AA_SUPERSAMPLE, 3, WR_SPREAD_JITTERED, WR_BUMP_INVARIANT, WR_SHADING_FLOAT, false },
    { WR_AA_ADAPTIVE, 4, 0, WR_BUMP_BLINN, WR_SHADING_FLOAT, true },
    { WR_AA_FILTER, 1, 0, WR_BUMP_BLINN, WR_SHADING_FLOAT, false },
    { WR_AA_MOMENTS, 1, 0, WR_BUMP_BLINN, WR_SHADING_DOUBLE, false },
    { WR_AA_POINT, 1, 0, WR_BUMP_NONE, WR_SHADING_FLOAT, false },
};
enum { WAYS = sizeof ways / sizeof *ways };

static void take_way(const Way *way, WrScene *scene)
{
    scene->dials.aa = way->aa;
    scene->dials.samples = way->samples;
    scene->dials.spread = way->spread;
    scene->dials.shading = way->shading;
    scene->bump = way->bump;
    scene->camera.orthographic = way->orthographic;
}

static WrTriangles *mesh_number(int i)
{
    return i == 0   ? mesh_grid(on_sphere, 24, 12, true)
           : i == 1 ? mesh_grid(on_wave, 40, 9, true)
                    : mesh_grid(on_sphere, 6, 4, false);
}

static void the_bits_are_the_same(void **state)
{
    (void)state;
    static const char *const isas[] = { "ref", "v1", "v2", "v3", "v4" };
    static const int threads[] = { 1, 2, 7 };
    WrField *field = random_field(33, 20, 8);
    for (int i = 0; i < 6 * WAYS; i++) {
        WrScene *scene = scene_with(mesh_number(i / 2 / WAYS));
        take_way(&ways[i % WAYS], scene);
        scene->displaced = i / WAYS % 2;
        Shot first = shoot(scene, field, 111, 90, 1, "ref", false);
        assert_true(first.frame.covered > 500);
        for (int k = 0; k < 5; k++) {
            if (!wr_kernels_get(isas[k], false, NULL)) continue;
            Shot other = shoot(scene, field, 111, 90, threads[k % 3], isas[k], k == 3);
            if (!same_picture(&first, &other))
                fail_msg("mesh %d, way %d: %s differs by %g", i / 2 / WAYS, i % WAYS, isas[k],
                         (double)worst_difference(&first, &other));
            put_away(&other);
        }
        put_away(&first);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* Cached parts of a static view are bit-identical to a whole picture, and picking finds the visible point. */
static void resting_views_and_picks(void **state)
{
    (void)state;
    WrField *field = random_field(256, 256, 3);
    WrScene *scene = scene_with(mesh_grid(on_sphere, 30, 16, true));
    scene->replicate_u = scene->replicate_v = 1;
    WrError err = { "" };
    WrPool *pool = wr_pool_new(2);
    WrRenderer *renderer = wr_renderer_new(pool, NULL, &err);
    WrFrameRequest request = {
        .field = field, .scene = scene, .width = 200, .height = 160, .turn_deg = 15, .keep = true
    };
    WrFrame frame;
    assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
    double u, v;
    int face;
    int32_t triangle;
    assert_true(wr_renderer_pick(renderer, 100.5, 80.5, &u, &v, &face));
    assert_true(wr_renderer_pick_triangle(renderer, 100.5, 80.5, &triangle));
    assert_false(wr_renderer_pick(renderer, 2, 2, &u, &v, &face));
    double low[2] = { 2, 2 }, high[2] = { -2, -2 };
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *c =
            &scene->triangles->corners[scene->triangles->triangles[triangle].corner[k]];
        low[0] = fmin(low[0], (double)c->u), high[0] = fmax(high[0], (double)c->u);
        low[1] = fmin(low[1], (double)c->v), high[1] = fmax(high[1], (double)c->v);
    }
    assert_true(u >= low[0] - 1e-6 && u <= high[0] + 1e-6);
    assert_true(v >= low[1] - 1e-6 && v <= high[1] + 1e-6);
    WrProbe probe;
    assert_true(wr_reference_probe(field, scene, 200, 160, 15, 100.5, 80.5, &probe, &err));
    assert_true(probe.hit);
    assert_near(probe.u, u, 1e-5);
    assert_near(probe.v, v, 1e-5);
    WrField *edited = wr_field_share(field);
    const int i = (int)(u * 256), j = (int)((1 - v) * 256);
    wr_field_set(edited, i, j, 2);
    request.field = edited;
    assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
    assert_false(wr_plan_runs(frame.plan, WR_EFFECT_AGAIN));
    assert_true(frame.shaded < 200 * 160 / 2);
    Shot whole = shoot(scene, edited, 200, 160, 1, "ref", false);
    assert_memory_equal(frame.rgba, whole.frame.rgba, frame_bytes(&frame));
    put_away(&whole);
    wr_field_free(edited);
    wr_renderer_free(renderer);
    wr_pool_free(pool);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* ---- expected pictures ---- */

/* The pixels of which a shows another part of the surface than b: inner outlines of relief are a fraction of a pixel
   apart. They become those of b. Returns their number. */
static int adopt_outlines(float *a, const float *b, int pixels)
{
    int count = 0;
    for (int i = 0; i < pixels; i++, a += 4, b += 4) {
        if (!(fabsf(a[0] - b[0]) > 0.05f)) continue;
        memcpy(a, b, 4 * sizeof *a);
        count++;
    }
    return count;
}

/* RMS and largest difference of linear intensity where both cover the pixel fully; *apart: pixels covered by only
   one. */
static double difference(const float *a, const float *b, int pixels, double *worst, int *apart)
{
    double sum = 0;
    int count = 0;
    *worst = 0, *apart = 0;
    for (int i = 0; i < pixels; i++, a += 4, b += 4) {
        *apart += a[3] != b[3];
        if (a[3] != 1 || b[3] != 1) continue;
        for (int c = 0; c < 3; c++) {
            const double d = fabs((double)a[c] - (double)b[c]);
            *worst = fmax(*worst, d);
            sum += d * d;
        }
        count += 3;
    }
    return count > 0 ? sqrt(sum / count) : 1;
}

/* A triangulated plane equals the plane up to rounding of u and v: within 2e-5 of an intensity of 1 at these
   slopes. */
static void a_cut_plane_is_the_plane(void **state)
{
    (void)state;
    WrField *field = bumpy_field(64, 64);
    for (int way = 0; way < WAYS; way++) {
        WrScene *plane = scene_of("plane"), *mesh = scene_with(mesh_grid(on_plane, 13, 7, true));
        take_way(&ways[way], plane);
        take_way(&ways[way], mesh);
        mesh->rotate_deg = plane->rotate_deg = (WrVec3){ -30, 10, 0 };
        plane->posed = true;
        Shot a = shoot(plane, field, 150, 150, 2, NULL, false);
        Shot b = shoot(mesh, field, 150, 150, 2, NULL, false);
        double worst;
        int apart;
        const double rms = difference(a.frame.rgba, b.frame.rgba, 150 * 150, &worst, &apart);
        if (!(worst < 1e-4 && rms < 2e-5 && apart < 40))
            fail_msg("way %d: worst %g, rms %g, %d pixels apart", way, worst, rms, apart);
        put_away(&a);
        put_away(&b);
        wr_scene_free(plane);
        wr_scene_free(mesh);
    }
    wr_field_free(field);
}

/* Displaced, too: both are tessellated within a 16th of a pixel, in different ways. */
static void a_raised_cut_plane_is_the_raised_plane(void **state)
{
    (void)state;
    WrField *field = bumpy_field(61, 47);
    for (int k = 0; k < 2; k++) {
        WrScene *scenes[2] = { scene_of("plane"), scene_with(mesh_grid(on_plane, 13, 7, true)) };
        Shot shots[2];
        for (int i = 0; i < 2; i++) {
            WrScene *scene = scenes[i];
            scene->posed = scene->displaced = true;
            scene->rotate_deg = (WrVec3){ -40, 10, 17 };
            scene->replicate_u = 1.3, scene->replicate_v = -2;
            scene->dials.dice = 0.0625;
            scene->camera.orthographic = k;
            scene->sizes = (WrVec3){ 1, 0.8, 1.2 };
            shots[i] = shoot(scene, field, 150, 150, 2, NULL, false);
            assert_true(wr_plan_runs(shots[i].frame.plan, WR_EFFECT_DISPLACED));
        }
        double worst;
        int apart;
        const double rms =
            difference(shots[0].frame.rgba, shots[1].frame.rgba, 150 * 150, &worst, &apart);
        if (!(rms < 4e-3 && apart < 40)) fail_msg("rms %g, %d pixels apart", rms, apart);
        for (int i = 0; i < 2; i++) {
            put_away(&shots[i]);
            wr_scene_free(scenes[i]);
        }
    }
    wr_field_free(field);
}

/* The error of a triangulated sphere decreases by nearly two when cells are halved: gradients of u and v are of first
   order, positions and normals of second. */
static void cut_spheres_tend_to_the_sphere(void **state)
{
    (void)state;
    WrField *field = bumpy_field(128, 64);
    WrScene *sphere = scene_of("sphere");
    sphere->posed = true;
    sphere->rotate_deg = (WrVec3){ -60, 0, 30 };
    sphere->scheme = WR_SCHEME_BSPLINE;
    Shot round = shoot(sphere, field, 200, 200, 2, NULL, false);
    double before = 1;
    for (int n = 16; n <= 128; n *= 2) {
        WrScene *mesh = scene_with(mesh_grid(on_sphere, 2 * n, n, true));
        mesh->scheme = WR_SCHEME_BSPLINE;
        Shot cut = shoot(mesh, field, 200, 200, 2, NULL, false);
        double worst;
        int apart;
        const double rms = difference(round.frame.rgba, cut.frame.rgba, 200 * 200, &worst, &apart);
        if (!(rms < before / 1.4)) fail_msg("%d cells: rms %g after %g", n, rms, before);
        before = rms;
        put_away(&cut);
        wr_scene_free(mesh);
    }
    assert_true(before < 4e-3);
    put_away(&round);
    wr_scene_free(sphere);
    wr_field_free(field);
}

/* The reference uses rays and a tree, in double precision. */
static void the_reference_agrees(void **state)
{
    (void)state;
    const int w = 120, h = 100;
    WrField *field = bumpy_field(64, 32);
    for (int i = 0; i < 12; i += test_amount(1, 5)) {
        if (i == 9) continue; /* the ball again: a million facets in the reference */
        WrScene *scene = scene_with(mesh_number(i % 3));
        take_way(&ways[i / 3 % 2], scene);
        scene->displaced = i >= 6;
        if (scene->displaced)
            scene->height *= 2; /* more than half a pixel, which bump would do for */
        scene->dials.dice = 0.0625;
        scene->scheme = WR_SCHEME_BSPLINE_FIT;
        Shot got = shoot(scene, field, w, h, 2, NULL, false);
        float *rgba = true_picture(scene, field, w, h);
        double worst;
        int apart;
        const int other = scene->displaced ? adopt_outlines(rgba, got.frame.rgba, w * h) : 0;
        const double rms = difference(got.frame.rgba, rgba, w * h, &worst, &apart);
        /* samples within a 512th of an edge may belong to the neighbour */
        if (!(rms < 4e-3 && apart < 30 && other < w * h / 100))
            fail_msg("mesh %d: rms %g, %d apart, %d other", i, rms, apart, other);
        wr_free(rgba);
        put_away(&got);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* ---- masks and blended planes ---- */

/* An egg of unequal sides, tilted. */
static void on_egg(double u, double v, float p[3], float n[3])
{
    float q[3];
    on_sphere(u, v, q, n);
    p[0] = 1.3f * q[0] + 0.2f * q[2], p[1] = 0.9f * q[1], p[2] = 1.1f * q[2] - 0.3f * q[1];
    n[0] = q[0], n[1] = q[1], n[2] = q[2];
}

#define WEIGHTED 7

/* Soft and hard masks, blended planes, both, and mask tables; heights over 0 make the mask's own slopes count. */
static WrScene *weighted_scene(int i)
{
    WrScene *scene = scene_with(mesh_grid(on_egg, 24, 13, true));
    WrProjection p = { .kind = i == 1 ? WR_PROJECTION_CYLINDRICAL : WR_PROJECTION_BOX,
                       .cell = { 0.671, 0.913 },
                       .turn_deg = { 11.7, -31.3, 48.9 },
                       .crease_deg = WR_CREASE_NONE,
                       .facing_deg = 37.7 };
    WrError err = { "" };
    scene->replicate_u = scene->replicate_v = 1;
    if (i != 1) p.blend = i == 4 ? 1 : 0.43;
    if (i == 1 || i == 2) p.facing = WR_FACING_Z, p.facing_soft_deg = 33.3;
    if (i == 3) p.facing = WR_FACING_OUT;
    if (i == 4) p.facing = WR_FACING_OUT, p.facing_soft_deg = 60.3;
    if (i == 5) p.kind = WR_PROJECTION_UV;
    if (i >= 5) {
        WrField *mask = bumpy_field(29, 23);
        wr_scene_set_mask(scene, "mask", mask, 1);
        wr_field_free(mask);
    }
    if (!wr_scene_project(scene, &p, &err)) fail_msg("%s", err.text);
    assert_non_null(scene->triangles->weights);
    return scene;
}

static void weighted_meshes_are_the_reference(void **state)
{
    (void)state;
    const int w = 100, h = 80;
    WrField *field = bumpy_field(32, 20);
    for (int j = 0; j < 20; j++)
        for (int i = 0; i < 32; i++) wr_field_set(field, i, j, wr_field_get(field, i, j) + 1.7f);
    for (int i = 0; i < 3 * WEIGHTED; i += test_step(3, 4)) {
        WrScene *scene = weighted_scene(i % WEIGHTED);
        take_way(&ways[i / WEIGHTED % 2], scene);
        scene->displaced = i >= 2 * WEIGHTED;
        scene->height *= 2;
        scene->dials.dice = 0.0625;
        scene->scheme = WR_SCHEME_BSPLINE_FIT;
        Shot got = shoot(scene, field, w, h, 2, NULL, false);
        float *rgba = true_picture(scene, field, w, h);
        double worst;
        int apart;
        const int other = scene->displaced ? adopt_outlines(rgba, got.frame.rgba, w * h) : 0;
        const double rms = difference(got.frame.rgba, rgba, w * h, &worst, &apart);
        if (!(rms < 4e-3 && apart < 30 && other < w * h / 100))
            fail_msg("case %d: rms %g, %d apart, %d other", i, rms, apart, other);
        wr_free(rgba);
        put_away(&got);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void weighted_meshes_have_the_same_bits(void **state)
{
    (void)state;
    WrField *field = random_field(33, 20, 8);
    for (int i = 0; i < WEIGHTED * WAYS; i++) {
        WrScene *scene = weighted_scene(i % WEIGHTED);
        take_way(&ways[i / WEIGHTED], scene);
        scene->displaced = i % 2;
        Shot first = shoot(scene, field, 71, 60, 1, "ref", false);
        Shot other = shoot(scene, field, 71, 60, 2, NULL, i % 3 == 0);
        assert_true(first.frame.covered > 500);
        if (!same_picture(&first, &other))
            fail_msg("case %d differs by %g", i, (double)worst_difference(&first, &other));
        put_away(&first);
        put_away(&other);
        if (i < WEIGHTED && !scene->displaced) expect_refreshed(scene, i);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* A table of one height has no slopes; the soft mask's edge has. Where the mask ends the picture is that of the bare mesh. */
static void the_edge_of_a_mask_shows(void **state)
{
    (void)state;
    WrField *level = level_field(16, 16, 3);
    WrScene *scene = weighted_scene(1);
    Shot masked = shoot(scene, level, 160, 120, 2, NULL, false);
    scene->bump = WR_BUMP_NONE;
    Shot bare = shoot(scene, level, 160, 120, 2, NULL, false);
    int other = 0;
    for (int i = 0; i < 160 * 120; i++)
        other += memcmp(masked.frame.rgba + 4 * i, bare.frame.rgba + 4 * i, 16) != 0;
    assert_true(other > 1000 && other < masked.frame.covered / 2);
    put_away(&masked);
    put_away(&bare);
    wr_scene_free(scene);
    wr_field_free(level);
}

/* ---- edges ---- */

/* A fan around the centre: every `step`-th of `count` triangles, starting at number `from`. */
static WrTriangles *fan(int count, int from, int step)
{
    float(*points)[3] = wr_alloc((size_t)count + 1, sizeof *points);
    int32_t(*corners)[3] = wr_alloc((size_t)count, sizeof *corners);
    int32_t made = 0;
    for (int i = 0; i < count; i++) {
        points[i + 1][0] = (float)cos(2 * WR_PI * i / count);
        points[i + 1][1] = (float)sin(2 * WR_PI * i / count);
        if (i % step != from) continue;
        corners[made][1] = i + 1;
        corners[made++][2] = (i + 1) % count + 1;
    }
    WrError err = { "" };
    const WrTrianglesSource source = { .points = (const float(*)[3])points,
                                       .corners = (const int32_t(*)[3])corners,
                                       .point_count = count + 1,
                                       .triangle_count = made };
    WrTriangles *out = wr_triangles_new(&source, &err);
    if (!out) fail_msg("%s", err.text);
    wr_free(points);
    wr_free(corners);
    return out;
}

static WrScene *flat_on(WrTriangles *mesh, double turn)
{
    WrScene *scene = scene_with(mesh);
    scene->bump = WR_BUMP_NONE;
    scene->camera.orthographic = true;
    scene->camera.size = 1;
    scene->rotate_deg = (WrVec3){ 0, 0, turn };
    return scene;
}

static Shot shoot_flat(const WrScene *scene, const WrField *field)
{
    WrError err = { "" };
    Shot shot = { .pool = wr_pool_new(1) };
    shot.renderer = wr_renderer_new(shot.pool, NULL, &err);
    const WrFrameRequest request = { .field = field, .scene = scene, .width = 96, .height = 96 };
    if (!wr_renderer_frame(shot.renderer, &request, &shot.frame, &err)) fail_msg("%s", err.text);
    return shot;
}

/* HC134, HC135: no sample is lost or hit twice at the vertex or the edges of a fan: two fans of alternate triangles
   together cover the whole picture without overlap. Rotated by right angles, edges pass exactly through samples. */
static void each_sample_has_one_owner(void **state)
{
    (void)state;
    WrField *field = wr_field_new(4, 4, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    const int rounds = getenv("WR_FULL") ? 1000 : 100;
    for (int k = 0; k < rounds; k++) {
        const int count = 4 + 2 * (k % 9);
        WrScene *halves[2];
        Shot shots[2];
        for (int i = 0; i < 2; i++) {
            halves[i] = flat_on(fan(count, i, 2), k % 8 == 0 ? 90 * (k / 8) : 0.36 * 7.3 * k);
            /* the same camera for both, whatever the centres of their bounding spheres */
            wr_shape_default(WR_SURFACE_mesh, &halves[i]->shape);
            halves[i]->shape.value[WR_MESH_RADIUS] = 1;
            halves[i]->shape.value[WR_MESH_KEY] = i + 2 * k;
            shots[i] = shoot_flat(halves[i], field);
        }
        for (int i = 0; i < 96 * 96; i++) {
            const float sum = shots[0].frame.rgba[4 * i + 3] + shots[1].frame.rgba[4 * i + 3];
            if (sum != 1.0f)
                fail_msg("round %d: sample %d,%d has %g owners", k, i % 96, i / 96, (double)sum);
        }
        for (int i = 0; i < 2; i++) {
            put_away(&shots[i]);
            wr_scene_free(halves[i]);
        }
    }
    wr_field_free(field);
}

/* HC128: for two triangles with mirrored (u,v), and a table mirrored in the same way, the pictures mirror: bumps are
   raised on both. HC127: if (u,v) are collinear, slopes along the line still bend. */
static void mirrored_and_thin_maps_are_bent(void **state)
{
    (void)state;
    static const float points[4][3] = { { -1, 0, 0 }, { 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 } };
    static const float mirror[4][2] = { { 1, 0 }, { 0, 0 }, { 0, 1 }, { 1, 0 } };
    static const float line[4][2] = { { 1, 0 }, { 0, 0 }, { 0, 0 }, { 1, 0 } };
    static const int32_t corners[2][3] = { { 0, 1, 2 }, { 1, 3, 2 } };
    WrField *field = bumpy_field(64, 64);
    for (int k = 0; k < 2; k++) {
        WrError err = { "" };
        const WrTrianglesSource source = { .points = points,
                                           .uv = k ? line : mirror,
                                           .corners = corners,
                                           .point_count = 4,
                                           .triangle_count = 2 };
        WrScene *scene = scene_with(wr_triangles_new(&source, &err));
        scene->rotate_deg = (WrVec3){ 0, 0, 0 };
        scene->camera.orthographic = true;
        scene->lights[0].where = (WrVec3){ 0, 0.5, 1 };
        scene->replicate_u = scene->replicate_v = 1;
        float normals[96 * 96 * 3];
        WrPool *pool = wr_pool_new(1);
        WrRenderer *renderer = wr_renderer_new(pool, NULL, &err);
        WrFrame frame;
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 96, .height = 96, .normals = normals
        };
        assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
        double most = 0;
        for (int y = 0; y < 96; y++)
            for (int x = 0; x < 48; x++) {
                const float *a = normals + 3 * (96 * y + x), *b = normals + 3 * (96 * y + 95 - x);
                if (frame.rgba[4 * (96 * y + x) + 3] == 0 ||
                    frame.rgba[4 * (96 * y + 95 - x) + 3] == 0)
                    continue;
                assert_near((double)a[0], -(double)b[0], 1e-5);
                assert_near((double)a[1], (double)b[1], 1e-5);
                most = fmax(most, fabs((double)a[0]));
            }
        assert_true(most > 0.05); /* normals are bent */
        wr_renderer_free(renderer);
        wr_pool_free(pool);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* Random triangles, slivers and (u,v) of any size: all values of the picture are finite. */
static void no_mesh_makes_nonsense(void **state)
{
    (void)state;
    TestRandom random = { 21 };
    WrField *field = random_field(16, 16, 2);
    for (int round = 0; round < 60; round++) {
        float points[60][3], normals[60][3], uv[60][2];
        int32_t corners[20][3];
        for (int i = 0; i < 60; i++) {
            const double size = i % 7 == 0 ? 1e-7 : 1;
            for (int k = 0; k < 3; k++) {
                points[i][k] = (float)((test_random(&random) - 0.5) * size);
                normals[i][k] = (float)(test_random(&random) - 0.5);
            }
            for (int k = 0; k < 2; k++)
                uv[i][k] = (float)((test_random(&random) - 0.5) * (round % 3 ? 3 : 1e6));
            corners[i / 3][i % 3] = i;
        }
        WrError err = { "" };
        const WrTrianglesSource source = { .points = (const float(*)[3])points,
                                           .normals = (const float(*)[3])normals,
                                           .uv = (const float(*)[2])uv,
                                           .corners = (const int32_t(*)[3])corners,
                                           .point_count = 60,
                                           .triangle_count = 20 };
        WrScene *scene = scene_with(wr_triangles_new(&source, &err));
        take_way(&ways[round % WAYS], scene);
        Shot shot = shoot(scene, field, 64, 64, 1, NULL, false);
        for (int i = 0; i < 64 * 64 * 4; i++) assert_true(isfinite(shot.frame.rgba[i]));
        put_away(&shot);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bits_are_the_same),
        cmocka_unit_test(resting_views_and_picks),
        cmocka_unit_test(a_cut_plane_is_the_plane),
        cmocka_unit_test(a_raised_cut_plane_is_the_raised_plane),
        cmocka_unit_test(cut_spheres_tend_to_the_sphere),
        cmocka_unit_test(the_reference_agrees),
        cmocka_unit_test(weighted_meshes_are_the_reference),
        cmocka_unit_test(weighted_meshes_have_the_same_bits),
        cmocka_unit_test(the_edge_of_a_mask_shows),
        cmocka_unit_test(each_sample_has_one_owner),
        cmocka_unit_test(mirrored_and_thin_maps_are_bent),
        cmocka_unit_test(no_mesh_makes_nonsense),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
