/* test_normal_mips.c - slopes of a normal map are added to the table's: the map of a table produces the picture of
   that table, alone and beside another; filtered like the table. */
#include "test.h"
#include "field/scheme_list.h"
#include "mesh_grids.h"
#include "render_scenes.h"

#include "image/image.h"
#include "render/kernels/kern.h"
#include "scene/normal_map.h"

#define SIDE 96

/* The map of a table's central differences, in codes of that many bits; 32: unrounded. */
static WrImage *map_of(const WrField *field, double height, int bits, bool down)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const double last = bits == 8 ? 255 : 65535;
    WrImage *image = wr_image_new(w, h, 3, NULL);
    image->type = bits == 8 ? WR_PIXEL_U8 : bits == 16 ? WR_PIXEL_U16 : WR_PIXEL_F32;
    for (int t = 0; t < w * h; t++) {
        const int i = t % w, j = t / w, l = (i + w - 1) % w, r = (i + 1) % w;
        const int up = (j + h - 1) % h, low = (j + 1) % h;
        const double p =
            height * w / 2 * (double)(wr_field_get(field, r, j) - wr_field_get(field, l, j));
        const double q =
            height * h / 2 * (double)(wr_field_get(field, i, up) - wr_field_get(field, i, low));
        const double length = sqrt(1 + p * p + q * q);
        const double n[3] = { -p / length, (down ? q : -q) / length, 1 / length };
        for (int c = 0; c < 3; c++) {
            const double half = n[c] / 2 + 0.5;
            image->data[3 * t + c] = (float)(bits == 32 ? n[c] : floor(last * half + 0.5) / last);
        }
    }
    return image;
}

static void take_map(WrScene *scene, WrImage *file, bool down, bool found)
{
    WrNormalMapReport told;
    wr_image_free(scene->normals.image);
    scene->normals.image = wr_normal_map_decode(file,
                                                found  ? WR_GREEN_AUTO
                                                : down ? WR_GREEN_DOWN
                                                       : WR_GREEN_UP,
                                                0, WR_CODING_AUTO, &told, NULL);
    assert_true(scene->normals.image && told.green_down == down);
    scene->normals.strength = 1;
    wr_image_free(file);
}

static WrField *flat_field(void)
{
    return wr_field_new(24, 17, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
}

/* All bit depths, both signs, plane and sphere, modes and anti-aliasing: within the angular precision of the
   format. */
static void the_map_of_a_table_gives_its_picture(void **state)
{
    static const char *const surfaces[] = { "plane", "sphere", "torus", "cone" };
    static const struct {
        int bits;
        double within;
    } formats[] = { { 8, 0.09 }, { 16, 6e-4 }, { 32, 1e-4 } };
    (void)state;
    for (int k = 0; k < 48; k++) {
        WrField *field = bumpy_field(61, 46), *flat = flat_field();
        WrScene *scene = scene_of(surfaces[k % 4]);
        const bool down = k / 4 % 2;
        scene->replicate_u = 1 + k % 3, scene->replicate_v = 2;
        scene->bump = k % 5 == 1 ? WR_BUMP_INVARIANT : WR_BUMP_BLINN;
        scene->dials.aa = k % 7 == 2 ? WR_AA_FILTER : k % 7 == 4 ? WR_AA_MOMENTS : WR_AA_POINT;
        if (k % 7 == 6) scene->dials.aa = WR_AA_SUPERSAMPLE, scene->dials.samples = 2;
        if (k % 11 == 3) scene->dials.shading = WR_SHADING_DOUBLE;
        Shot bumped = shoot(scene, field, SIDE, SIDE, 2, "auto", false);
        take_map(scene, map_of(field, scene->height, formats[k % 3].bits, down), down, k & 1);
        scene->height = 0.9; /* affects the flat table, not the map */
        Shot mapped = shoot(scene, flat, SIDE, SIDE, 2, "auto", false);
        const float off = worst_difference(&bumped, &mapped);
        if (getenv("WR_SHOW"))
            printf("%2d %-6s %2d bits: %g\n", k, surfaces[k % 4], formats[k % 3].bits, (double)off);
        if (!(off < formats[k % 3].within)) fail_msg("case %d: %g", k, (double)off);
        assert_true(mapped.frame.plan->rows[WR_EFFECT_NORMALS].ran);
        assert_false(mapped.frame.plan->rows[WR_EFFECT_BUMP].ran);
        put_away(&bumped);
        put_away(&mapped);
        wr_scene_free(scene);
        wr_field_free(field);
        wr_field_free(flat);
    }
}

/* Table and map of one size: the picture of their sum. */
static void slopes_of_map_and_table_add(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        WrField *field = bumpy_field(40, 31), *more = random_field(40, 31, 3);
        WrField *both = wr_field_new(40, 31, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        for (int t = 0; t < 40 * 31; t++)
            wr_field_set(both, t % 40, t / 40,
                         wr_field_get(field, t % 40, t / 40) +
                             0.2f * wr_field_get(more, t % 40, t / 40));
        WrScene *scene = scene_of(k & 1 ? "sphere" : "plane");
        scene->dials.aa = k & 2 ? WR_AA_FILTER : WR_AA_POINT;
        if (k & 4) scene->dials.shading = WR_SHADING_DOUBLE;
        Shot sum = shoot(scene, both, SIDE, SIDE, 2, "auto", false);
        take_map(scene, map_of(more, 0.4 * scene->height, 32, false), false, false);
        scene->normals.strength = 0.5;
        Shot added = shoot(scene, field, SIDE, SIDE, 2, "auto", false);
        const float off = worst_difference(&sum, &added);
        if (!(off < 2e-4f)) fail_msg("case %d: %g", k, (double)off);
        put_away(&sum);
        put_away(&added);
        wr_scene_free(scene);
        wr_field_free(field);
        wr_field_free(more);
        wr_field_free(both);
    }
}

static WrScene *mixed_scene(int k)
{
    static const char *const surfaces[] = { "torus", "sphere", "plane", "mesh", "cylinder" };
    static const WrAntialias aas[] = { WR_AA_POINT, WR_AA_FILTER, WR_AA_MOMENTS, WR_AA_ADAPTIVE };
    WrScene *scene = scene_of(surfaces[k % 5]);
    if (k % 5 == 3)
        wr_scene_set_triangles(scene, mesh_grid(on_sphere, 24, 12, true), "a.obj", NULL);
    WrField *of = random_field(33 + k, 101, (uint64_t)k + 5);
    take_map(scene, map_of(of, 0.01, k & 1 ? 8 : 32, false), false, false);
    wr_field_free(of);
    scene->dials.aa = aas[k % 4];
    scene->dials.footprint = k & 2 ? WR_FOOTPRINT_ANISOTROPIC : WR_FOOTPRINT_ISOTROPIC;
    if (k % 7 == 5) scene->bump = WR_BUMP_EXACT;
    if (k % 7 == 3) scene->bump = WR_BUMP_INVARIANT;
    if (k % 5 == 4) scene->dials.shading = WR_SHADING_DOUBLE;
    if (k % 8 == 6) scene->dials.shading = WR_SHADING_HALF;
    if (k % 3 == 2) scene->scheme = WR_SCHEME_BSPLINE;
    if (k % 9 == 7) scene->material.gate = true;
    scene->normals.frame = (WrNormalFrame)(k / 2 % 4);
    scene->normals.object = k % 11 == 8;
    scene->normals.combine = (WrCombine)(k % 4 % WR_COMBINE_COUNT);
    return scene;
}

static void planned_full_threads_and_instruction_sets_agree_to_the_bit(void **state)
{
    static const char *const sets[] = { "ref", "v1", "v2", "v3", "v4" };
    (void)state;
    for (int k = 0; k < (getenv("WR_FULL") ? 90 : 12); k++) {
        WrField *field = k % 3 ? random_field(70, 41, (uint64_t)k) : flat_field();
        WrScene *scene = mixed_scene(k);
        Shot first = shoot(scene, field, 150, 70, 1, "auto", false);
        Shot full = shoot(scene, field, 150, 70, 3, "auto", true);
        const bool bounded = scene->bump != WR_BUMP_BLINN; /* class B on some surfaces */
        const float off = worst_difference(&first, &full);
        if (!(off <= (bounded ? 1e-4f : 0))) fail_msg("case %d: full: %g", k, (double)off);
        for (int s = 0; s < 5; s++) {
            if (!wr_kernels_get(sets[s], false, NULL)) continue;
            Shot other = shoot(scene, field, 150, 70, 2 + s, sets[s], false);
            if (!same_picture(&first, &other)) fail_msg("case %d: %s", k, sets[s]);
            put_away(&other);
        }
        put_away(&first);
        put_away(&full);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* A flat map, or a strength of 0: bit-identical to none. */
static void maps_without_slopes_are_left_out(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        WrField *field = bumpy_field(40, 31), *flat = flat_field();
        WrScene *scene = scene_of(k & 1 ? "sphere" : "plane");
        Shot none = shoot(scene, field, SIDE, SIDE, 2, "auto", false);
        take_map(scene, map_of(k & 2 ? field : flat, 0.1, 32, false), false, false);
        if (k & 2) scene->normals.strength = 0;
        Shot planned = shoot(scene, field, SIDE, SIDE, 2, "auto", false);
        Shot full = shoot(scene, field, SIDE, SIDE, 2, "auto", true);
        assert_false(wr_plan_runs(planned.frame.plan, WR_EFFECT_NORMALS));
        assert_true(wr_plan_runs(full.frame.plan, WR_EFFECT_NORMALS));
        assert_true(same_picture(&none, &planned) && same_picture(&none, &full));
        put_away(&none);
        put_away(&planned);
        put_away(&full);
        wr_scene_free(scene);
        wr_field_free(field);
        wr_field_free(flat);
    }
}

static void a_resting_view_is_refreshed_to_the_bits_of_a_new_picture(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        WrScene *scene = mixed_scene(k);
        scene->replicate_u = scene->replicate_v = 1;
        expect_refreshed(scene, k);
        wr_scene_free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_map_of_a_table_gives_its_picture),
        cmocka_unit_test(slopes_of_map_and_table_add),
        cmocka_unit_test(planned_full_threads_and_instruction_sets_agree_to_the_bit),
        cmocka_unit_test(maps_without_slopes_are_left_out),
        cmocka_unit_test(a_resting_view_is_refreshed_to_the_bits_of_a_new_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
