/* Pictures of a cube whose faces have separate cells of the table: the content of other cells is not visible on any
   pixel, for any fetch, and the picture equals the reference's. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "render/reference/reference.h"

#define SIZE 90

static WrScene *cube_of_cells(void)
{
    WrScene *scene = scene_of("cube");
    scene->shape.value[wr_surface_param_offset(WR_SURFACE_cube, "faces")] = 6;
    scene->replicate_u = scene->replicate_v = 1;
    return scene;
}

/* Random heights that differ only outside the cells of the two faces. Cells are three columns by two rows from the
   lower left. */
static WrField *field_with(int w, int h, const int keep[2], uint64_t others)
{
    TestRandom same = { 77 }, other = { others };
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int k = 0; k < w * h; k++) {
        const int face = k % w * 3 / w + 3 * (1 - k / w * 2 / h);
        const float a = (float)test_random(&same), b = (float)test_random(&other);
        wr_field_set(field, k % w, k / w, face == keep[0] || face == keep[1] ? a : 5 * b);
    }
    return field;
}

/* One kind of fetch: schemes, filters over footprints larger than the margin, all samples. */
static void set_way(WrScene *scene, int way)
{
    static const WrAntialias aa[] = { WR_AA_POINT, WR_AA_FILTER, WR_AA_MOMENTS, WR_AA_SUPERSAMPLE,
                                      WR_AA_ADAPTIVE };
    scene->scheme = (WrScheme)(way % WR_SCHEME_COUNT);
    scene->dials.aa = aa[way % 5];
    scene->dials.samples = 3;
    scene->dials.footprint = way % 2 ? WR_FOOTPRINT_ANISOTROPIC : WR_FOOTPRINT_ISOTROPIC;
    scene->dials.shading = way % 7 == 6 ? WR_SHADING_DOUBLE : WR_SHADING_FLOAT;
    scene->bump = way % 4 == 3 ? WR_BUMP_EXACT : WR_BUMP_BLINN;
}

static Shot picture(const WrScene *scene, const WrField *field, int size, int way)
{
    return shoot(scene, field, size, size, 2, way % 3 ? "auto" : "ref", false);
}

/* The front face alone, seen frontally, and two faces at grazing angles with cells above each other; in pictures so
   small that a pixel covers many texels. */
static void other_cells_show_on_no_face(void **state)
{
    static const int sizes[][2] = { { 192, 128 }, { 399, 256 }, { 768, 512 } };
    (void)state;
    for (int way = 0; way < 30; way++) {
        const bool graze = way / 5 % 2;
        const int keep[2] = { 0, graze ? 3 : 0 }, *size = sizes[way % 3];
        if (wr_schemes[way % WR_SCHEME_COUNT].taps == WR_TAPS_FITTED) continue; /* whole-table */
        WrScene *scene = cube_of_cells();
        set_way(scene, way);
        scene->posed = true;
        scene->rotate_deg = (WrVec3){ 0, (graze ? 65 : 0) - 15, 0 }; /* shoot turns by 15 */
        scene->camera.orthographic = way % 2 == 0;
        WrField *a = field_with(size[0], size[1], keep, 5),
                *b = field_with(size[0], size[1], keep, 6);
        WrField *none = field_with(size[0], size[1], (const int[2]){ 7, 7 }, 5);
        for (int pixels = 14; pixels <= 60; pixels += 46) {
            Shot one = picture(scene, a, pixels, way), two = picture(scene, b, pixels, way);
            Shot three = picture(scene, none, pixels, way);
            if (!same_picture(&one, &two)) fail_msg("way %d, %d pixels", way, pixels);
            assert_false(same_picture(&one, &three)); /* its own heights show */
            put_away(&one);
            put_away(&two);
            put_away(&three);
        }
        wr_field_free(none);
        wr_field_free(b);
        wr_field_free(a);
        wr_scene_free(scene);
    }
}

/* Colours in single precision compared with the reference's, at the same points. */
static void assert_agrees(const WrScene *scene, const WrField *field, int min)
{
    Shot shot = shoot(scene, field, SIZE, SIZE, 2, "auto", false);
    WrReference ours = { 0 };
    WrError err = { "" };
    const WrReferenceRequest request = { .field = field,
                                         .scene = scene,
                                         .width = SIZE,
                                         .height = SIZE,
                                         .turn_deg = 15,
                                         .first = 1,
                                         .most = 1 };
    if (!wr_reference_render(&request, shot.pool, &ours, &err)) fail_msg("%s", err.text);
    int both = 0, unlike = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float *a = shot.frame.rgba + 4 * i;
        const double *b = ours.rgba + 4 * i;
        if ((double)a[3] != b[3]) unlike++;
        else both += b[3] > 0;
        bool far = false;
        for (int c = 0; c < 3 && (double)a[3] == b[3]; c++) far |= fabs((double)a[c] - b[c]) > 2e-4;
        unlike += far;
    }
    assert_true(both > min);
    assert_in_range(unlike, 0, 12); /* along edges, where single precision hits the other face */
    wr_reference_fini(&ours);
    put_away(&shot);
}

static void cells_look_as_the_reference_says(void **state)
{
    (void)state;
    WrField *field = random_field(153, 98, 3);
    for (int k = 0; k < 4; k++) {
        WrScene *scene = cube_of_cells();
        scene->scheme = WR_SCHEME_BSPLINE_FIT; /* used by the reference */
        scene->bump = k / 2 ? WR_BUMP_EXACT : WR_BUMP_INVARIANT;
        scene->height = 0.01;
        scene->posed = true;
        scene->rotate_deg = (WrVec3){ 30 + 170 * (k & 1), 40 + 80 * k, 10 };
        assert_agrees(scene, field, 1500);
        scene->camera.fit = false; /* from within */
        scene->camera.eye = (WrVec3){ 0.05, -0.1, 0.2 };
        scene->camera.target = v3_add(scene->camera.eye, (WrVec3){ 0.1, -0.2, -1 });
        scene->camera.fov_deg = 80;
        scene->lights[0] = (WrLight){ WR_LIGHT_POINT, scene->camera.eye, { 1, 1, 1 }, 1, 0, false };
        assert_agrees(scene, field, 8000);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* The position reported for a pixel is in the cell of the reported face. */
static void places_are_in_their_faces_cells(void **state)
{
    (void)state;
    WrField *field = random_field(96, 64, 3);
    WrScene *scene = cube_of_cells();
    Shot shot = shoot(scene, field, SIZE, SIZE, 2, "auto", false);
    int hits = 0, of[6] = { 0 };
    for (int i = 0; i < SIZE * SIZE; i++) {
        double u, v;
        int face;
        if (!wr_renderer_pick(shot.renderer, i % SIZE + 0.5, i / SIZE + 0.5, &u, &v, &face))
            continue;
        const double x = 3 * u - face % 3, y = 2 * v - face / 3;
        assert_in_range(face, 0, 5);
        assert_true(x > 1 / 32.0 - 1e-5 && x < 31 / 32.0 + 1e-5);
        assert_true(y > 1 / 32.0 - 1e-5 && y < 31 / 32.0 + 1e-5);
        assert_int_equal(wr_surface_face(&scene->shape, 0, u, v), face);
        hits++, of[face]++;
    }
    assert_true(hits > 1500 && of[0] > 100 && of[1] + of[3] > 100 && of[4] > 100);
    put_away(&shot);
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_cells_show_on_no_face),
        cmocka_unit_test(cells_look_as_the_reference_says),
        cmocka_unit_test(places_are_in_their_faces_cells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
