/* test_plan.c - the table of effects: each effect runs exactly under the conditions of its row, reports match the
   run, and skipped effects change the picture no more than the row's proof allows. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"
#include "mesh_grids.h"

#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"
#include "shade/reflection_models.h"

#define SIDE 64

/* A separate scene and table, to be changed by a case. */
typedef struct Stage {
    WrScene *scene;
    WrField *field;
    bool rests; /* the picture was rendered before, and one texel has changed since */
} Stage;

typedef void (*Change)(Stage *stage);

/* ---- scenes ---------------------------------------------------------------------------------------- */

static void keep_all(Stage *stage)
{
    (void)stage;
}

static void take_surface(Stage *stage, const char *name)
{
    wr_shape_default((WrSurfaceKind)wr_surface_find(name), &stage->scene->shape);
}

static void no_diffuse(Stage *stage)
{
    stage->scene->material.diffuse = 0;
}

static void dark(Stage *stage)
{
    for (int i = 0; i < stage->scene->light_count; i++) stage->scene->lights[i].strength = 0;
}

static void black(Stage *stage)
{
    stage->scene->material.colour = (WrVec3){ 0, 0, 0 };
}

static void no_specular(Stage *stage)
{
    stage->scene->material.specular = 0;
}

static void coloured(Stage *stage)
{
    WrImage *image = wr_image_new(8, 8, 3, NULL);
    for (int i = 0; i < 8 * 8 * 3; i++) image->data[i] = (float)(i % 7) / 7;
    stage->scene->colour = image;
}

static void white(Stage *stage)
{
    coloured(stage);
    for (int i = 0; i < 8 * 8 * 3; i++) stage->scene->colour->data[i] = 1;
}

static void level(Stage *stage)
{
    for (int i = 0; i < 64 * 64; i++) wr_field_set(stage->field, i % 64, i / 64, 0.25f);
}

static void no_height(Stage *stage)
{
    stage->scene->height = 0;
}

static void no_replication(Stage *stage)
{
    stage->scene->replicate_u = stage->scene->replicate_v = 0;
}

/* Central differences over two texels are 0. */
static void checkered(Stage *stage)
{
    for (int i = 0; i < 64 * 64; i++)
        wr_field_set(stage->field, i % 64, i / 64, (float)((i + i / 64) % 2));
}

static void smooth(Stage *stage)
{
    stage->scene->bump = WR_BUMP_NONE;
}

static void bilinear(Stage *stage)
{
    stage->scene->scheme = WR_SCHEME_BILINEAR;
}

static void far_replicated(Stage *stage)
{
    stage->scene->replicate_u = stage->scene->replicate_v = 3001;
}

static void invariant(Stage *stage)
{
    stage->scene->bump = WR_BUMP_INVARIANT;
}

static void invariant_square(Stage *stage)
{
    invariant(stage);
    take_surface(stage, "plane");
}

static void displaced(Stage *stage)
{
    stage->scene->displaced = true;
}

static void parallaxed(Stage *stage)
{
    stage->scene->parallax = true;
}

static void exact(Stage *stage)
{
    stage->scene->bump = WR_BUMP_EXACT;
    stage->scene->height = 0.1;
}

static void exact_cube(Stage *stage)
{
    exact(stage);
    take_surface(stage, "cube");
}

static void shadowed(Stage *stage)
{
    stage->scene->material.shadow = true;
}

static void occluded(Stage *stage)
{
    stage->scene->material.occlusion = true;
}

static void occluded_in_the_dark(Stage *stage)
{
    occluded(stage);
    stage->scene->material.ambient = 0;
}

static void supersampled(Stage *stage)
{
    stage->scene->dials.aa = WR_AA_SUPERSAMPLE;
    stage->scene->dials.samples = 3;
}

static void one_sample(Stage *stage)
{
    supersampled(stage);
    stage->scene->dials.samples = 1;
}

static void bounded(Stage *stage)
{
    stage->scene->dials.aa = WR_AA_ADAPTIVE;
    stage->scene->dials.refine = WR_REFINE_BOUND;
    stage->scene->dials.contrast = 0.3;
    stage->scene->dials.samples = 8; /* 4 x 4 bounds would cost more than they save */
    stage->scene->height = 0.001;
}

static void bounded_torus(Stage *stage)
{
    bounded(stage);
    take_surface(stage, "torus");
}

static void filtered(Stage *stage)
{
    stage->scene->dials.aa = WR_AA_FILTER;
}

static void tinted(Stage *stage)
{
    coloured(stage);
    filtered(stage);
}

static void tinted_evenly(Stage *stage)
{
    tinted(stage);
    for (int i = 0; i < 8 * 8 * 3; i++) stage->scene->colour->data[i] = 0.1f * (float)(i % 3 + 1);
}

static void tinted_still(Stage *stage)
{
    tinted(stage);
    stage->scene->colour_laid.own = true; /* 0 times */
}

static void mapped(Stage *stage)
{
    WrNormalMap *map = &stage->scene->normals;
    map->image = wr_image_new(8, 8, 3, NULL);
    for (int i = 0; i < 64; i++) {
        map->image->data[3 * i] = 0.1f * (float)(i % 7);
        map->image->data[3 * i + 2] = sqrtf(1 - 0.01f * (float)(i % 7 * (i % 7)));
    }
    map->strength = 1;
}

static void mapped_flat(Stage *stage)
{
    mapped(stage);
    for (int i = 0; i < 64; i++) stage->scene->normals.image->data[3 * i] = 0;
}

static void mapped_still(Stage *stage)
{
    mapped(stage);
    no_replication(stage);
}

static void mapped_dark(Stage *stage)
{
    mapped(stage);
    dark(stage);
}

static void mapped_smooth(Stage *stage)
{
    mapped(stage);
    smooth(stage);
}

static void reoriented(Stage *stage)
{
    mapped(stage);
    stage->scene->normals.combine = WR_COMBINE_REORIENTED;
}

static void reoriented_alone(Stage *stage)
{
    reoriented(stage);
    no_height(stage);
}

static void filtered_still(Stage *stage)
{
    exact(stage);
    filtered(stage);
    no_replication(stage);
}

static void moments(Stage *stage)
{
    stage->scene->dials.aa = WR_AA_MOMENTS;
    stage->scene->dials.moments = WR_MOMENTS_LEAN;
}

static void moments_dull(Stage *stage)
{
    moments(stage);
    no_specular(stage);
}

static void curl(Stage *stage)
{
    take_surface(stage, "curl");
}

static void torus(Stage *stage)
{
    take_surface(stage, "torus");
}

static void keep_all_hides(Stage *stage)
{
    stage->scene->lights[0].shadow = true;
}

static void torus_hides(Stage *stage)
{
    torus(stage);
    keep_all_hides(stage);
    stage->scene->lights[0].where = (WrVec3){ -0.83, 0.4, 0.31 };
}

static void hides_in_the_dark(Stage *stage)
{
    torus_hides(stage);
    dark(stage);
}

static void hides_without_rays(Stage *stage)
{
    torus_hides(stage);
    stage->scene->dials.rays = 0;
}

static void torus_flat_on(Stage *stage)
{
    torus(stage);
    stage->scene->posed = true;
    stage->scene->camera.orthographic = true;
}

static void cube(Stage *stage)
{
    take_surface(stage, "cube");
}

static void cube_hides(Stage *stage)
{
    cube(stage);
    keep_all_hides(stage);
}

static void cube_from_within(Stage *stage)
{
    cube(stage);
    stage->scene->camera.fit = false;
    stage->scene->camera.eye = (WrVec3){ 0.1, 0.05, 0.02 };
    stage->scene->camera.target = (WrVec3){ 1, 0.3, 0.1 };
}

static void orthographic(Stage *stage)
{
    stage->scene->camera.orthographic = true;
}

static void resting(Stage *stage)
{
    stage->rests = true;
}

static void eight_bits(Stage *stage)
{
    stage->scene->dials.heights = WR_HEIGHTS_8;
}

static void shaded_double(Stage *stage)
{
    stage->scene->dials.shading = WR_SHADING_DOUBLE;
}

static void heights_double(Stage *stage)
{
    stage->scene->dials.heights = WR_HEIGHTS_DOUBLE;
}

static void shaded_half(Stage *stage)
{
    stage->scene->dials.shading = WR_SHADING_HALF;
}

static void smooth_double(Stage *stage)
{
    smooth(stage);
    shaded_double(stage);
    take_surface(stage, "cylinder");
}

static void smooth_cone(Stage *stage)
{
    smooth(stage);
    take_surface(stage, "cone");
    stage->scene->lights[0].kind = WR_LIGHT_POINT;
}

/* Slopes in one corner of many tiles. */
static void mostly_level(Stage *stage)
{
    wr_field_free(stage->field);
    stage->field = wr_field_new(256, 256, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.25f, NULL);
    for (int i = 100; i < 120; i++) wr_field_set(stage->field, i, 2 * i / 3, (float)(i % 7));
}

static void from_behind(Stage *stage)
{
    stage->scene->lights[0].where = (WrVec3){ 0.3, 0.5, -1 };
    stage->scene->height = 0.001;
}

static void ungated(Stage *stage)
{
    from_behind(stage);
    stage->scene->material.gate = false;
}

static void mesh_ball(Stage *stage)
{
    take_surface(stage, "mesh");
    wr_scene_set_triangles(stage->scene, mesh_grid(on_sphere, 24, 12, true), NULL, NULL);
}

static void mesh_square(Stage *stage)
{
    take_surface(stage, "mesh");
}

static void mesh_dark(Stage *stage)
{
    mesh_ball(stage);
    dark(stage);
}

/* ---- the cases ------------------------------------------------------------------------------------- */

enum {
    NOTHING = -1 /* cannot run, even if forced */
};

typedef struct Off {
    Change change;
    double apart; /* allowed difference of the picture if the effect is forced; or NOTHING */
} Off;

/* A wall in front of the sphere, or beside it. */
static void one_behind(Stage *stage)
{
    WrScene *scene = stage->scene, *wall = wr_scene_clone(scene);
    wr_shape_default(WR_SURFACE_plane, &wall->shape);
    wall->at = (WrVec3){ -0.6, 0, 1.2 };
    scene->others = wr_alloc(1, sizeof *scene->others);
    scene->others[scene->other_count++] = wall;
}

static void wooden(Stage *stage)
{
    stage->scene->grain = wr_grains[WR_SOLID_TEXTURE_WOOD].usual;
}

static void wooden_white(Stage *stage)
{
    wooden(stage);
    WrSolidTexture *grain = &stage->scene->grain;
    for (int c = 0; c < 3; c++) grain->light[c] = grain->dark[c] = 1;
}

static void wooden_even(Stage *stage)
{
    wooden(stage);
    WrSolidTexture *grain = &stage->scene->grain;
    for (int c = 0; c < 3; c++) grain->light[c] = grain->dark[c] = 0.37;
}

static void wooden_round(Stage *stage)
{
    wooden(stage);
    stage->scene->grain.amount = 0;
}

static void checkered_through(Stage *stage)
{
    stage->scene->grain = wr_grains[WR_SOLID_TEXTURE_CHECKER].usual;
}

static void wooden_far(Stage *stage)
{
    wooden(stage);
    filtered(stage);
}

static void of_facets(Stage *stage);

static void roughened(Stage *stage)
{
    wooden(stage);
    of_facets(stage);
    stage->scene->grain.drives = WR_SOLID_TEXTURE_ROUGHENS;
}

static void worn(Stage *stage)
{
    WrImage *image = wr_image_new(7, 5, 1, NULL);
    of_facets(stage);
    for (int i = 0; i < 35; i++) image->data[i] = 0.3f + 0.01f * (float)(i * 7 % 35);
    stage->scene->facets[WR_FACET_ROUGHNESS].image = image;
}

static void worn_dull(Stage *stage)
{
    worn(stage);
    stage->scene->material.model = WR_REFLECT_BLINN_PHONG;
}

static void roughened_dull(Stage *stage)
{
    roughened(stage);
    stage->scene->material.model = WR_REFLECT_BLINN_PHONG;
}

static void embossed(Stage *stage)
{
    wooden(stage);
    stage->scene->grain.drives = WR_SOLID_TEXTURE_BUMPS;
}

static void embossed_flat(Stage *stage)
{
    embossed(stage);
    stage->scene->grain.height = 0;
}

static void embossed_dark(Stage *stage)
{
    embossed(stage);
    dark(stage);
}

static void of_facets(Stage *stage)
{
    stage->scene->material.model = WR_REFLECT_GGX;
}

static void matt_smooth(Stage *stage)
{
    stage->scene->material.model = WR_REFLECT_OREN_NAYAR;
    stage->scene->material.roughness = 0;
}

static void of_cavities(Stage *stage)
{
    stage->scene->material.model = WR_REFLECT_TORRANCE_SPARROW;
    stage->scene->material.roughness = 0.45;
}

static void metal(Stage *stage)
{
    of_facets(stage);
    stage->scene->material.metalness = 1;
}

static void facets_undiffuse(Stage *stage)
{
    of_facets(stage);
    no_diffuse(stage);
}

static void facets_published(Stage *stage)
{
    of_facets(stage);
    stage->scene->material.energy = WR_ENERGY_PUBLISHED;
}

/* Half of the picture is closer than texel size, the other farther. */
static void moments_of_facets(Stage *stage)
{
    moments(stage);
    of_facets(stage);
    stage->scene->material.roughness = 0.37;
    stage->scene->replicate_u = 0.61, stage->scene->replicate_v = 0.83;
}

static void moments_round(Stage *stage)
{
    moments_of_facets(stage);
    stage->scene->dials.moments = WR_MOMENTS_TOKSVIG;
}

static void moments_small(Stage *stage)
{
    moments(stage);
    stage->scene->replicate_u = 0.61, stage->scene->replicate_v = 0.83;
}

static void faint_plastic(Stage *stage)
{
    of_facets(stage);
    stage->scene->material.roughness = 0.23;
    stage->scene->dials.faint = 1e-3;
}

static void faint_metal(Stage *stage)
{
    metal(stage);
    stage->scene->material.roughness = 0.2;
    stage->scene->dials.faint = 4e-3;
}

static void faint_cavities(Stage *stage)
{
    of_cavities(stage);
    stage->scene->material.roughness = 0.1;
    stage->scene->dials.faint = 1e-3;
}

static void faint_worn(Stage *stage)
{
    worn(stage);
    stage->scene->dials.faint = 1e-3;
}

static void phong_dull(Stage *stage)
{
    stage->scene->material.model = WR_REFLECT_PHONG;
    stage->scene->material.specular = 0;
}

/* Only the highlight is lit, with intensity 0. */
static void metal_black(Stage *stage)
{
    of_facets(stage);
    stage->scene->material.metalness = 1;
    stage->scene->material.specular = 0;
}

/* Brighter at the right; or of one colour. */
static void surround(Stage *stage, float step, double strength)
{
    WrImage *image = wr_image_new(8, 4, 3, NULL);
    WrEnvironmentMapChanges changes;
    for (int i = 0; i < 8 * 4 * 3; i++) image->data[i] = 0.3f + step * (float)(i / 3 % 8);
    image->type = WR_PIXEL_F32;
    WrEnvironment *to = &stage->scene->environment;
    wr_environment_set(to, WR_ENVIRONMENT_MAP_FILE, wr_environment_map_new(image, &changes, NULL),
                       "sky", NULL);
    to->strength = strength;
    wr_image_free(image);
}

static void surrounded(Stage *stage)
{
    surround(stage, 0.07f, 0.7);
}

static void surrounded_evenly(Stage *stage)
{
    surround(stage, 0, 0.7);
}

static void surrounded_weakly(Stage *stage)
{
    surround(stage, 0.07f, 0);
}

static void surrounded_black(Stage *stage)
{
    surrounded(stage);
    black(stage);
}

static void surrounded_dull(Stage *stage)
{
    surrounded(stage);
    no_diffuse(stage);
}

static void no_shine_around(Stage *stage)
{
    surrounded(stage);
    no_specular(stage);
}

static void matt_around(Stage *stage)
{
    surrounded(stage);
    stage->scene->material.model = WR_REFLECT_OREN_NAYAR;
}

static void mirror_around(Stage *stage)
{
    surrounded(stage);
    stage->scene->material.model = WR_REFLECT_GGX;
    stage->scene->material.roughness = 0.01;
}

static void to_horizon(Stage *stage)
{
    wr_shape_default(WR_SURFACE_plane, &stage->scene->shape);
    stage->scene->shape.value[2] = 1;
    stage->scene->posed = true;
    stage->scene->rotate_deg = (WrVec3){ -80, 0, 0 };
}

static void to_horizon_parallel(Stage *stage)
{
    to_horizon(stage);
    stage->scene->camera.orthographic = true;
}

typedef struct Case {
    Change on; /* NULL: it runs only by force */
    Off off[5];
} Case;

static const Case cases[WR_EFFECT_COUNT] = {
    [WR_EFFECT_DIFFUSE] = { keep_all, { { no_diffuse, 0 }, { dark, 0 }, { black, 0 } } },
    [WR_EFFECT_SPECULAR] = { keep_all, { { no_specular, 0 }, { dark, 0 } } },
    [WR_EFFECT_MODEL] = { of_facets,
                          { { keep_all, NOTHING },
                            { matt_smooth, 1e-6 },
                            { phong_dull, 1e-6 },
                            { metal_black, NOTHING } } },
    [WR_EFFECT_KEPT] = { of_facets,
                         { { metal, 0 },
                           { facets_undiffuse, 0 },
                           { keep_all, NOTHING },
                           { facets_published, NOTHING } } },
    [WR_EFFECT_SURROUND] = { surrounded,
                             { { surrounded_weakly, 0 },
                               { surrounded_black, 0 },
                               { surrounded_dull, 0 },
                               { keep_all, NOTHING } } },
    [WR_EFFECT_HARMONICS] = { surrounded, { { surrounded_evenly, 0 }, { keep_all, NOTHING } } },
    [WR_EFFECT_MIRROR] = { surrounded,
                           { { surrounded_weakly, 0 },
                             { no_shine_around, 0 },
                             { matt_around, NOTHING },
                             { keep_all, NOTHING } } },
    [WR_EFFECT_BLUR] = { surrounded,
                         { { surrounded_evenly, 1e-5 },
                           { mirror_around, 0.05 },
                           { no_shine_around, NOTHING } } },
    [WR_EFFECT_COLOUR] = { coloured, { { white, 0 }, { keep_all, NOTHING } } },
    [WR_EFFECT_NORMALS] = { mapped,
                            { { mapped_flat, 0 },
                              { mapped_still, 0 },
                              { mapped_dark, 0 },
                              { mapped_smooth, NOTHING },
                              { keep_all, NOTHING } } },
    [WR_EFFECT_GRAIN] = { wooden, { { wooden_white, 0 }, { keep_all, NOTHING } } },
    [WR_EFFECT_OCTAVES] = { wooden,
                            { { wooden_round, 0 },
                              { checkered_through, NOTHING },
                              { wooden_even, NOTHING },
                              { keep_all, NOTHING } } },
    [WR_EFFECT_FADED] = { wooden_far, { { wooden, NOTHING }, { filtered, NOTHING } } },
    [WR_EFFECT_FACETS] = { worn,
                           { { worn_dull, NOTHING },
                             { of_facets, NOTHING },
                             { keep_all, NOTHING } } },
    [WR_EFFECT_VARIED] = { roughened,
                           { { roughened_dull, NOTHING },
                             { wooden, NOTHING },
                             { keep_all, NOTHING } } },
    [WR_EFFECT_EMBOSSED] = { embossed,
                             { { embossed_flat, 1e-5 },
                               { embossed_dark, 1e-5 },
                               { wooden, NOTHING },
                               { keep_all, NOTHING } } },
    [WR_EFFECT_TINT] = { tinted,
                         { { tinted_evenly, 0 },
                           { tinted_still, 0 },
                           { coloured, NOTHING },
                           { filtered, NOTHING } } },
    [WR_EFFECT_DISPLACED] = { displaced, { { keep_all, NOTHING } } },
    [WR_EFFECT_PARALLAX] = { parallaxed, { { keep_all, NOTHING } } },
    [WR_EFFECT_BUMP] = { keep_all,
                         { { no_height, 0 },
                           { no_replication, 0 },
                           { level, 0 },
                           { checkered, 0 },
                           { smooth, NOTHING } } },
    [WR_EFFECT_REORIENTED] = { reoriented, { { reoriented_alone, 0 }, { mapped, NOTHING } } },
    [WR_EFFECT_GRADIENT] = { keep_all, { { bilinear, NOTHING } } },
    [WR_EFFECT_WIDE] = { far_replicated, { { keep_all, 1e-3 }, { smooth, NOTHING } } },
    [WR_EFFECT_INVARIANT] = { invariant, { { invariant_square, 1e-5 }, { keep_all, NOTHING } } },
    [WR_EFFECT_EXACT] = { exact, { { exact_cube, 1e-5 }, { keep_all, NOTHING } } },
    [WR_EFFECT_CURVATURE] = { exact, { { keep_all, 0 }, { smooth, 0 } } },
    [WR_EFFECT_SHADOW] = { shadowed, { { keep_all, NOTHING } } },
    [WR_EFFECT_CAST] = { torus_hides,
                         { { keep_all_hides, 0 },
                           { cube_hides, 0 },
                           { hides_in_the_dark, NOTHING },
                           { hides_without_rays, NOTHING },
                           { keep_all, NOTHING } } },
    [WR_EFFECT_OCCLUSION] = { occluded, { { occluded_in_the_dark, 0 }, { keep_all, NOTHING } } },
    [WR_EFFECT_SAMPLES] = { supersampled, { { keep_all, NOTHING }, { one_sample, NOTHING } } },
    [WR_EFFECT_BOUND] = { bounded, { { keep_all, NOTHING }, { bounded_torus, NOTHING } } },
    [WR_EFFECT_FILTER] = { filtered, { { filtered_still, 0 }, { keep_all, NOTHING } } },
    [WR_EFFECT_BACK] = { curl,
                         { { keep_all, 0 }, { torus, 0 }, { torus_flat_on, 0 }, { cube, 0 } } },
    [WR_EFFECT_DEPTH] = { torus, { { keep_all, NOTHING } } },
    [WR_EFFECT_NEWTON] = { torus, { { keep_all, NOTHING } } },
    [WR_EFFECT_PERSPECTIVE] = { keep_all, { { orthographic, NOTHING } } },
    [WR_EFFECT_AGAIN] = { keep_all, { { resting, 0 } } },
    [WR_EFFECT_STEADY] = { keep_all, { { dark, NOTHING } } },
    [WR_EFFECT_BESIDE] = { NULL, { { keep_all, 0 }, { torus, 0 }, { cube, 0 } } },
    [WR_EFFECT_SPREAD] = { moments, { { filtered, NOTHING }, { moments_dull, NOTHING } } },
    [WR_EFFECT_WIDENED] = { NULL,
                            { { moments, 0 },
                              { moments_of_facets, 0 },
                              { moments_round, 0 },
                              { moments_small, 0 },
                              { filtered, NOTHING } } },
    [WR_EFFECT_FACED] = { roughened,
                          { { of_facets, 0 },
                            { faint_cavities, 0 },
                            { moments_of_facets, 0 },
                            { faint_plastic, 0 },
                            { keep_all, NOTHING } } },
    [WR_EFFECT_FAINT] = { NULL,
                          { { faint_plastic, 1e-3 },
                            { faint_metal, 4e-3 },
                            { faint_cavities, 1e-3 },
                            { of_facets, NOTHING },
                            { faint_worn, NOTHING } } },
    [WR_EFFECT_ROUNDED] = { eight_bits, { { keep_all, NOTHING } } },
    [WR_EFFECT_DOUBLE] = { shaded_double, { { keep_all, NOTHING } } },
    [WR_EFFECT_HALF] = { shaded_half, { { keep_all, NOTHING } } },
    [WR_EFFECT_PARAMETERS] = { keep_all,
                               { { smooth, 0 },
                                 { level, 0 },
                                 { smooth_double, 0 },
                                 { smooth_cone, 0 },
                                 { cube, NOTHING } } },
    [WR_EFFECT_TANGENTS] = { keep_all,
                             { { smooth, 0 },
                               { smooth_double, 0 },
                               { smooth_cone, 0 },
                               { dark, NOTHING },
                               { cube, NOTHING } } },
    [WR_EFFECT_DARK] = { ungated,
                         { { keep_all, 0 },
                           { from_behind, 0 },
                           { smooth_double, 0 },
                           { smooth_cone, 0 },
                           { dark, NOTHING } } },
    [WR_EFFECT_GROUND] = { keep_all, { { mostly_level, 0 }, { smooth, NOTHING } } },
    [WR_EFFECT_HIDDEN] = { NULL, { { one_behind, 0 }, { keep_all, NOTHING } } },
    [WR_EFFECT_BETWEEN] = { one_behind, { { keep_all, NOTHING } } },
    [WR_EFFECT_SMOOTH] = { mesh_ball,
                           { { mesh_square, 1e-5 }, { mesh_dark, 1e-5 }, { keep_all, NOTHING } } },
    [WR_EFFECT_BLOCKS] = { mesh_square, { { mesh_ball, 0 }, { keep_all, NOTHING } } },
    [WR_EFFECT_HORIZON] = { to_horizon,
                            { { to_horizon_parallel, NOTHING }, { keep_all, NOTHING } } },
};

static Stage stage_of(Change change)
{
    Stage stage = { .scene = scene_of("sphere"), .field = bumpy_field(64, 64) };
    stage.scene->scheme = WR_SCHEME_CENTRAL;
    stage.scene->bump = WR_BUMP_BLINN;
    stage.scene->material.diffuse = 0.7;
    stage.scene->material.specular = 0.5;
    stage.scene->material.shininess = 20;
    change(&stage);
    return stage;
}

static void strike(Stage *stage)
{
    wr_scene_free(stage->scene);
    wr_field_free(stage->field);
}

/* The picture of a stage with one effect forced. */
static Shot forced(const Stage *stage, WrEffect effect, WrForce how)
{
    WrForce force[WR_EFFECT_COUNT] = { WR_FORCE_NONE };
    Shot shot = { .pool = wr_pool_new(2) };
    shot.renderer = wr_renderer_new(shot.pool, "auto", NULL);
    force[effect] = how;
    WrFrameRequest request = { .field = stage->field,
                               .scene = stage->scene,
                               .width = SIDE,
                               .height = SIDE,
                               .turn_deg = 15,
                               .keep = stage->rests,
                               .force = force };
    if (stage->rests) {
        const float was = wr_field_get(stage->field, 20, 30);
        wr_field_set(stage->field, 20, 30, was + 1);
        assert_true(wr_renderer_frame(shot.renderer, &request, &shot.frame, NULL));
        wr_field_set(stage->field, 20, 30, was);
    }
    assert_true(wr_renderer_frame(shot.renderer, &request, &shot.frame, NULL));
    assert_true(shot.frame.covered > SIDE);
    return shot;
}

/* The output of `explain` for each effect matches the recorded stages. */
static void says_what_ran(const Shot *shot, WrEffect about, const char *how)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        const WrPlanRow *row = &shot->frame.plan->rows[e];
        if (row->run != row->ran)
            fail_msg("%s %s: the plan says that %s %s, and it %s", wr_effects[about].name, how,
                     row->name, row->run ? "runs" : "is left out", row->ran ? "ran" : "did not");
    }
}

static void expect(const Shot *shot, WrEffect effect, bool run, const char *how)
{
    const WrPlanRow *row = &shot->frame.plan->rows[effect];
    says_what_ran(shot, effect, how);
    if (row->run != run || !row->reason[0])
        fail_msg("%s %s: %s (%s)", row->name, how, row->run ? "runs" : "is left out", row->reason);
}

/* ---- each effect ----------------------------------------------------------------------------------- */

static void each_effect_runs_where_it_is_called_for(void **state)
{
    (void)state;
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        const WrEffectInfo *info = &wr_effects[e];
        if (!cases[e].on) continue;
        Stage stage = stage_of(cases[e].on);
        Shot on = forced(&stage, (WrEffect)e, WR_FORCE_NONE);
        Shot off = forced(&stage, (WrEffect)e, WR_FORCE_OFF);
        expect(&on, (WrEffect)e, true, "on");
        expect(&off, (WrEffect)e, info->only_way, "forced off");
        if (same_picture(&on, &off) != info->only_way)
            fail_msg("%s: forced off, the picture is %s", info->name,
                     info->only_way ? "another" : "the same: nothing calls for it");
        put_away(&on);
        put_away(&off);
        strike(&stage);
    }
}

static void check_off(WrEffect effect, const Off *off)
{
    const WrEffectInfo *info = &wr_effects[effect];
    const bool can = off->apart >= 0;
    Stage stage = stage_of(off->change);
    Shot without = forced(&stage, effect, WR_FORCE_NONE),
         with = forced(&stage, effect, WR_FORCE_ON);
    expect(&without, effect, false, "off");
    expect(&with, effect, can, "forced on");
    const double apart = (double)worst_difference(&without, &with);
    if (!(apart <= (can ? off->apart : 0)))
        fail_msg("%s: forced on, the picture is %g apart", info->name, apart);
    if (off->apart <= 0 && !same_picture(&without, &with)) fail_msg("%s: other bits", info->name);
    if (can) assert_true((info->proof == WR_PROOF_IDENTICAL) == (off->apart == 0));
    put_away(&without);
    put_away(&with);
    strike(&stage);
}

static void what_is_left_out_changes_no_more_than_its_proof_allows(void **state)
{
    (void)state;
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        assert_non_null(cases[e].off[0].change);
        for (int k = 0; k < 5 && cases[e].off[k].change; k++)
            check_off((WrEffect)e, &cases[e].off[k]);
    }
}

/* With a known bound no pixel differs from K x K by more than `contrast`. */
static void a_bound_keeps_within_its_contrast(void **state)
{
    (void)state;
    Stage stage = stage_of(bounded);
    Shot on = forced(&stage, WR_EFFECT_BOUND, WR_FORCE_NONE);
    Shot off = forced(&stage, WR_EFFECT_BOUND, WR_FORCE_OFF);
    assert_true((double)worst_difference(&on, &off) <= stage.scene->dials.contrast);
    assert_true(on.frame.shaded < off.frame.shaded);
    put_away(&on);
    put_away(&off);
    strike(&stage);
}

/* Statistics of runs are worth testing: most of a plastic sphere has no highlight. */
static void faint_highlights_are_not_worked_out(void **state)
{
    (void)state;
    static const Change changes[] = { faint_plastic, faint_cavities };
    for (int k = 0; k < 2; k++) {
        Stage stage = stage_of(changes[k]);
        take_surface(&stage, "plane");
        stage.scene->height *= 0.07; /* runs of small slope show little beyond their middle */
        Shot shot = forced(&stage, WR_EFFECT_FAINT, WR_FORCE_NONE);
        const WrPlanRow *shine = &shot.frame.plan->rows[WR_EFFECT_SPECULAR];
        if (!(shine->pixels > 0 && shine->pixels < shot.frame.shaded * 7 / 10))
            fail_msg("scene %d: highlights on %lld of %lld samples", k, (long long)shine->pixels,
                     (long long)shot.frame.shaded);
        put_away(&shot);
        strike(&stage);
    }
}

/* The inner walls of a closed object are visible from inside. */
static void backs_are_seen_from_within(void **state)
{
    (void)state;
    Stage stage = stage_of(cube_from_within);
    Shot shot = forced(&stage, WR_EFFECT_BACK, WR_FORCE_NONE);
    expect(&shot, WR_EFFECT_BACK, true, "from within");
    put_away(&shot);
    strike(&stage);
    stage = stage_of(heights_double);
    shot = forced(&stage, WR_EFFECT_DOUBLE, WR_FORCE_NONE);
    expect(&shot, WR_EFFECT_DOUBLE, true, "of heights");
    put_away(&shot);
    strike(&stage);
}

/* ---- the table ------------------------------------------------------------------------------------- */

static WrPlan plan_of(const Stage *stage)
{
    WrPlan plan;
    const WrPlanRequest ask = { .scene = stage->scene, .dials = &stage->scene->dials };
    wr_plan_build(&plan, &ask);
    return plan;
}

static void rows_are_whole(void **state)
{
    (void)state;
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        const WrEffectInfo *info = &wr_effects[e];
        assert_true(info->rule && info->name && info->left_out && info->decide);
        assert_true((info->proof == WR_PROOF_BOUNDED) == (info->bound != NULL));
        assert_non_null(cases[e].off[0].change);
    }
}

/* A difference in any setting that a row controls, or in whether it runs, makes plans different. */
static void plans_are_compared_in_all_that_rows_own(void **state)
{
    (void)state;
    Stage stage = stage_of(keep_all);
    const WrPlan plan = plan_of(&stage);
    WrPlan other = plan;
    assert_true(wr_plan_same(&plan, &other));
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        other.rows[e].run = !plan.rows[e].run;
        assert_int_equal(wr_plan_same(&plan, &other), wr_effects[e].manner);
        other = plan;
    }
#define CHECK(effect, type, name)                                                                  \
    other.name = (type)(plan.name == (type)0);                                                     \
    if (wr_plan_same(&plan, &other)) fail_msg("%s is not compared", #name);                        \
    other = plan;
    WR_PLAN_SETTINGS(CHECK)
#undef CHECK
    strike(&stage);
}

/* A stage's time is charged to its effect if that runs, else to a separate cost; none is lost. */
static void every_stage_is_charged_once(void **state)
{
    (void)state;
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        for (int s = 0; s < WR_STAGE_COUNT; s++) {
            WrPlan plan = { .work = 0 };
            double costs = 0;
            plan.rows[e].run = true;
            wr_plan_charge(&plan, (WrStage)s, 1);
            for (int c = 0; c < WR_COST_COUNT; c++) costs += plan.cost[c];
            const bool owned = wr_effects[e].stages >> s & 1;
            assert_true(plan.rows[e].seconds == (owned ? 1 : 0) && costs == (owned ? 0 : 1));
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_whole),
        cmocka_unit_test(each_effect_runs_where_it_is_called_for),
        cmocka_unit_test(what_is_left_out_changes_no_more_than_its_proof_allows),
        cmocka_unit_test(a_bound_keeps_within_its_contrast),
        cmocka_unit_test(faint_highlights_are_not_worked_out),
        cmocka_unit_test(backs_are_seen_from_within),
        cmocka_unit_test(plans_are_compared_in_all_that_rows_own),
        cmocka_unit_test(every_stage_is_charged_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
