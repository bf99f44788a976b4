/* test_plan_scenes.c - the catalogue of scenes S01 to S32, as in ui/guide/plan.md: exactly the listed effects run in
   each; with all effects forced the picture is bit-identical, on any number of threads and instruction set. And the
   effects that run after the smallest change to an input of a proof. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "base/file.h"
#include "image/image.h"
#include "render/frame/frame_internal.h"
#include "render/kernels/kern.h"

#include <float.h>

#define SIDE 96

typedef struct Stage {
    WrScene *scene;
    WrField *field;
} Stage;

typedef void (*Change)(Stage *stage);

/* ---- the scenes ------------------------------------------------------------------------------------ */

static void take_table(Stage *stage, WrField *field)
{
    wr_field_free(stage->field);
    stage->field = field;
}

static void take_surface(Stage *stage, const char *name)
{
    wr_shape_default((WrSurfaceKind)wr_surface_find(name), &stage->scene->shape);
}

static void flat_table(Stage *stage)
{
    take_table(stage, level_field(64, 64, 0.25));
    stage->scene->material.specular = 0;
}

static void one_texel(Stage *stage)
{
    flat_table(stage);
    take_table(stage, level_field(512, 512, 0.25));
    wr_field_set(stage->field, 330, 200, 0.5f);
    stage->scene->replicate_u = stage->scene->replicate_v = 1;
}

static void no_highlight(Stage *stage)
{
    stage->scene->material.specular = 0;
}

static void only_highlight(Stage *stage)
{
    stage->scene->material.diffuse = 0;
}

static void least_highlight(Stage *stage)
{
    stage->scene->material.specular = 1e-30;
}

static void from_behind(Stage *stage)
{
    flat_table(stage);
    stage->scene->material.specular = 0.5;
    stage->scene->lights[0].where = (WrVec3){ 0, 0, -1 };
}

/* F increases evenly: the ends of the table are its only steps. */
static void ramp(Stage *stage)
{
    WrField *field = wr_field_new(64, 64, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, NULL);
    for (int i = 0; i < 64 * 64; i++) wr_field_set(field, i % 64, i / 64, (float)(i % 64) / 64);
    take_table(stage, field);
    take_surface(stage, "plane");
    stage->scene->posed = true;
    stage->scene->replicate_u = stage->scene->replicate_v = 1;
    stage->scene->camera.orthographic = true;
    stage->scene->dials.aa = WR_AA_ADAPTIVE;
    stage->scene->dials.samples = 4;
    stage->scene->dials.refine = WR_REFINE_BOUND;
    stage->scene->dials.contrast = 0.05;
}

static void ramp_near(Stage *stage)
{
    ramp(stage);
    stage->scene->camera.orthographic = false;
}

static void exact_plane(Stage *stage)
{
    take_surface(stage, "plane");
    stage->scene->bump = WR_BUMP_EXACT;
}

static void exact_low(Stage *stage)
{
    stage->scene->bump = WR_BUMP_EXACT;
    stage->scene->height = 0.001;
}

static void exact_high(Stage *stage)
{
    stage->scene->bump = WR_BUMP_EXACT;
    stage->scene->height = 0.3;
}

static void invariant_square(Stage *stage)
{
    take_surface(stage, "plane");
    stage->scene->bump = WR_BUMP_INVARIANT;
}

static void invariant(Stage *stage)
{
    stage->scene->bump = WR_BUMP_INVARIANT;
}

static void bricks(Stage *stage, int replicate)
{
    WrField *field = level_field(64, 64, 0.25);
    for (int i = 0; i < 64 * 64; i++)
        if (i % 64 % 16 < 2 || i / 64 % 16 < 2) wr_field_set(field, i % 64, i / 64, 0);
    take_table(stage, field);
    take_surface(stage, "plane");
    stage->scene->replicate_u = stage->scene->replicate_v = replicate;
    stage->scene->dials.aa = WR_AA_FILTER;
}

static void bricks_far(Stage *stage)
{
    bricks(stage, 12);
}

static void bricks_near(Stage *stage)
{
    bricks(stage, 1);
    stage->scene->replicate_u = stage->scene->replicate_v = 0.25;
}

/* A light 10 degrees above the plane; slopes far below that, and far above. */
static void grazed(Stage *stage, double height)
{
    take_surface(stage, "plane");
    stage->scene->posed = true;
    stage->scene->rotate_deg = (WrVec3){ 0, 0, 0 };
    stage->scene->replicate_u = stage->scene->replicate_v = 1;
    stage->scene->height = height;
    stage->scene->material.shadow = true;
    stage->scene->lights[0].where = (WrVec3){ 0.2, 0.95, 0.17 };
}

static void grazed_gently(Stage *stage)
{
    grazed(stage, 1e-4);
}

static void grazed_roughly(Stage *stage)
{
    grazed(stage, 0.1);
}

static void checkered(Stage *stage)
{
    for (int i = 0; i < 64 * 64; i++)
        wr_field_set(stage->field, i % 64, i / 64, (float)((i + i / 64) % 2));
}

static void checkered_bilinear(Stage *stage)
{
    checkered(stage);
    stage->scene->scheme = WR_SCHEME_BILINEAR;
}

static void least_table(Stage *stage)
{
    take_table(stage, level_field(1, 1, 0.25));
}

static void still(Stage *stage)
{
    stage->scene->replicate_u = stage->scene->replicate_v = 0;
}

static void torus(Stage *stage)
{
    take_surface(stage, "torus");
}

static void from_within(Stage *stage)
{
    stage->scene->camera.fit = false;
    stage->scene->camera.eye = (WrVec3){ 0.1, 0.05, 0.02 };
    stage->scene->camera.target = (WrVec3){ 1, 0.3, 0.1 };
}

static void not_a_number(Stage *stage)
{
    take_surface(stage, "plane");
    stage->scene->replicate_u = stage->scene->replicate_v = 0.25;
    wr_field_set(stage->field, 50, 10, NAN);
}

static void all_at_once(Stage *stage)
{
    torus(stage);
    exact_high(stage);
    WrImage *image = wr_image_new(8, 8, 3, NULL);
    for (int i = 0; i < 8 * 8 * 3; i++) image->data[i] = (float)(i % 7) / 7;
    stage->scene->colour = image;
    stage->scene->replicate_u = stage->scene->replicate_v = 2000;
    stage->scene->material.gate = false;
    stage->scene->dials.aa = WR_AA_SUPERSAMPLE;
    stage->scene->dials.samples = 2;
    stage->scene->dials.heights = WR_HEIGHTS_8;
    stage->scene->dials.shading = WR_SHADING_HALF;
}

/* Solid noise that bends normals, with many cells per pixel, or few. */
static void noise_far(Stage *stage)
{
    WrSolidTexture *grain = &stage->scene->grain;
    *grain = wr_grains[WR_SOLID_TEXTURE_NOISE].usual;
    grain->drives = WR_SOLID_TEXTURE_BUMPS;
    grain->cells = 200;
    stage->scene->height = 0;
    stage->scene->dials.aa = WR_AA_FILTER;
}

static void noise_near(Stage *stage)
{
    noise_far(stage);
    stage->scene->grain.cells = 0.5;
}

static void wood_of_no_amplitude(Stage *stage)
{
    stage->scene->grain = wr_grains[WR_SOLID_TEXTURE_WOOD].usual;
    stage->scene->grain.amount = 0;
    stage->scene->height = 0;
}

static void constant_surroundings(Stage *stage)
{
    WrImage *image = wr_image_new(4, 2, 3, NULL);
    WrEnvironmentMapChanges changes;
    for (int i = 0; i < 24; i++) image->data[i] = 0.37f;
    image->type = WR_PIXEL_F32;
    wr_environment_set(&stage->scene->environment, WR_ENVIRONMENT_MAP_FILE,
                       wr_environment_map_new(image, &changes, NULL), "sky", NULL);
    stage->scene->environment.strength = 0.7;
    wr_image_free(image);
}

/* Of the visible faces, 0 has bumps, 3 letters (here two strokes), and 4 is empty. */
static void faces(Stage *stage)
{
    WrField *field = level_field(1152, 768, 0.25);
    for (int k = 0; k < 300 * 300; k++) {
        const int i = 40 + k % 300, j = 40 + k / 300;
        wr_field_set(field, i, 384 + j, 0.25f + 0.01f * (float)((i * 7 + j * 5) % 13));
        if (j > 150 && j < 180) wr_field_set(field, i, j, 0.5f);
    }
    take_table(stage, field);
    take_surface(stage, "cube");
    stage->scene->shape.value[wr_surface_param_offset(WR_SURFACE_cube, "faces")] = 6;
    stage->scene->replicate_u = stage->scene->replicate_v = 1;
    stage->scene->posed = true;
    stage->scene->rotate_deg = (WrVec3){ 30, 20, 0 };
}

/* A small sphere with a colour texture, completely behind a larger one. */
static void hidden_sphere(Stage *stage)
{
    WrScene *front = stage->scene, *back = wr_scene_clone(front);
    WrImage *image = wr_image_new(8, 8, 3, NULL);
    for (int i = 0; i < 8 * 8 * 3; i++) image->data[i] = (float)(i % 7) / 7;
    back->colour = image;
    back->at = (WrVec3){ 0.05, -0.03, -2.2 };
    back->size = 0.3;
    front->others = wr_alloc(1, sizeof *front->others);
    front->others[front->other_count++] = back;
    front->chosen = 1;
    front->camera.fit = false; /* a fit would include the other */
    front->camera.eye = (WrVec3){ 0, 0, 4 };
}

/* ---- expected effects ----------------------------------------------------------------------------- */

#define E(name) WR_EFFECT_BIT(WR_EFFECT_##name)
#define NEW (E(AGAIN) | E(STEADY))
#define LIGHT (E(DIFFUSE) | E(SPECULAR))
#define NEAR (E(PERSPECTIVE) | NEW) /* a new picture in perspective */
#define ROUND (E(PARAMETERS) | E(TANGENTS))
#define RELIEF (E(BUMP) | E(GRADIENT) | E(GROUND)) /* a table with slopes everywhere */
#define OPEN E(BACK)                               /* an open surface, whose back is visible */
#define MET (E(DEPTH) | E(NEWTON))                 /* a surface without a closed-form inverse */

typedef struct Scene {
    const char *id;
    Change change; /* NULL: the scene needs features that the program lacks */
    WrEffects run;
    double apart; /* class B: allowed difference with all effects forced */
} Scene;

static const Scene scenes[] = {
    { "S01", flat_table, E(DIFFUSE) | NEAR, 0 },
    { "S02", one_texel, E(DIFFUSE) | NEAR | ROUND | E(BUMP) | E(GRADIENT), 0 },
    { "S03", no_highlight, E(DIFFUSE) | NEAR | ROUND | RELIEF, 0 },
    { "S04", only_highlight, E(SPECULAR) | NEAR | ROUND | RELIEF, 0 },
    { "S05", least_highlight, LIGHT | NEAR | ROUND | RELIEF, 0 },
    { "S06", from_behind, NEAR, 0 },
    { "S07", ramp, LIGHT | NEW | RELIEF | OPEN | E(SAMPLES) | E(BOUND) | E(DARK), 0 },
    { "S08", ramp_near, LIGHT | NEAR | RELIEF | OPEN | E(SAMPLES) | E(BOUND) | E(DARK), 0 },
    { "S09", exact_plane, LIGHT | NEAR | RELIEF | OPEN, 1e-5 },
    { "S10", exact_low, LIGHT | NEAR | ROUND | RELIEF | E(EXACT) | E(CURVATURE) | E(DARK), 0 },
    { "S11", exact_high, LIGHT | NEAR | ROUND | RELIEF | E(EXACT) | E(CURVATURE) | E(DARK), 0 },
    { "S12", invariant_square, LIGHT | NEAR | RELIEF | OPEN, 1e-5 },
    { "S13", invariant, LIGHT | NEAR | ROUND | RELIEF | E(INVARIANT) | E(DARK), 0 },
    { "S14", bricks_far, LIGHT | NEAR | E(BUMP) | E(GROUND) | OPEN | E(FILTER) | E(DARK), 0 },
    { "S15", bricks_near, LIGHT | NEAR | RELIEF | OPEN | E(FILTER) | E(DARK), 0 },
    { "S16", grazed_gently, LIGHT | NEAR | RELIEF | OPEN | E(SHADOW), 0 },
    { "S17", grazed_roughly, LIGHT | NEAR | RELIEF | OPEN | E(SHADOW), 0 },
    { "S18", checkered, LIGHT | NEAR, 0 },
    { "S18", checkered_bilinear, LIGHT | NEAR | ROUND | E(BUMP) | E(GROUND) | E(DARK), 0 },
    { "S19", least_table, LIGHT | NEAR, 0 },
    { "S20", still, LIGHT | NEAR, 0 },
    { "S21", noise_far, LIGHT | NEAR | E(EMBOSSED) | E(OCTAVES) | E(FADED) | E(DARK), 0 },
    { "S22", noise_near, LIGHT | NEAR | E(EMBOSSED) | E(OCTAVES) | E(FADED) | E(DARK), 0 },
    { "S23", wood_of_no_amplitude, LIGHT | NEAR | E(GRAIN), 0 },
    { "S24", faces, LIGHT | NEAR | E(BUMP) | E(GRADIENT), 0 },
    { "S25", hidden_sphere, LIGHT | NEAR | ROUND | RELIEF | E(BETWEEN), 0 },
    { "S26", torus, LIGHT | NEAR | RELIEF | MET, 0 },
    { "S27", from_within, LIGHT | NEAR | ROUND | RELIEF | OPEN, 0 },
    { "S28", constant_surroundings,
      LIGHT | NEAR | ROUND | RELIEF | E(SURROUND) | E(MIRROR) | E(DARK), 1e-5 },
    /* S29 and S30 concern a second picture: below */
    { "S31", not_a_number, LIGHT | NEAR | RELIEF | OPEN, 0 },
    { "S32", all_at_once,
      LIGHT | NEAR | RELIEF | MET | E(COLOUR) | E(WIDE) | E(EXACT) | E(CURVATURE) | E(SAMPLES) |
          E(ROUNDED) | E(HALF) | E(DARK),
      0 },
};
#define SCENES (sizeof scenes / sizeof *scenes)

static Stage stage_of(Change change)
{
    Stage stage = { .scene = scene_of("sphere"), .field = bumpy_field(64, 64) };
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

static Shot shot_of(const Stage *stage, int threads, const char *isa, bool full)
{
    return shoot(stage->scene, stage->field, SIDE, SIDE, threads, isa, full);
}

static void each_scene_runs_what_it_calls_for(void **state)
{
    (void)state;
    for (size_t i = 0; i < SCENES; i++) {
        if (!scenes[i].change) continue;
        Stage stage = stage_of(scenes[i].change);
        Shot shot = shot_of(&stage, 2, "auto", false);
        for (int e = 0; e < WR_EFFECT_COUNT; e++) {
            const WrPlanRow *row = &shot.frame.plan->rows[e];
            if (row->ran != (scenes[i].run >> e & 1))
                fail_msg("%s: %s %s (%s)", scenes[i].id, row->name,
                         row->ran ? "ran" : "did not run", row->reason);
        }
        put_away(&shot);
        strike(&stage);
    }
}

static void check_full(const Scene *scene, int threads, const char *isa)
{
    Stage stage = stage_of(scene->change);
    Shot planned = shot_of(&stage, threads, isa, false), full = shot_of(&stage, 2, isa, true);
    const double apart = (double)worst_difference(&planned, &full);
    if (!(scene->apart > 0 ? apart <= scene->apart : same_picture(&planned, &full)))
        fail_msg("%s, %s, %d threads: %g apart", scene->id, isa, threads, apart);
    put_away(&planned);
    put_away(&full);
    strike(&stage);
}

static void all_forced_make_the_same_picture(void **state)
{
    static const int threads[] = { 1, 2, 7 };
    static const char *const sets[] = { "ref", "v1", "v2", "v3", "v4" };
    (void)state;
    for (size_t i = 0; i < SCENES; i++)
        for (int k = 0; k < 5 && scenes[i].change; k++)
            if (wr_kernels_get(sets[k], false, NULL))
                for (int t = 0; t < 3; t++) check_full(&scenes[i], threads[t], sets[k]);
}

/* ---- counts ---------------------------------------------------------------------------------------- */

/* S02, S06, S14, S15: fraction of the picture. */
static void effects_run_where_they_are_called_for(void **state)
{
    (void)state;
    Stage stage = stage_of(one_texel);
    Shot shot = shoot(stage.scene, stage.field, 400, 400, 2, "auto", false);
    const WrPlan *plan = shot.frame.plan;
    assert_in_range(plan->rows[WR_EFFECT_BUMP].pixels, 1, shot.frame.shaded / 4);
    assert_in_range(plan->rows[WR_EFFECT_BUMP].tiles, 1, plan->rows[WR_EFFECT_SAMPLES].tiles + 6);
    put_away(&shot);
    strike(&stage);
    stage = stage_of(from_behind);
    shot = shot_of(&stage, 2, "auto", false);
    assert_int_equal(shot.frame.plan->rows[WR_EFFECT_DIFFUSE].pixels, 0);
    assert_int_equal(shot.frame.plan->rows[WR_EFFECT_SPECULAR].pixels, 0);
    put_away(&shot);
    strike(&stage);
    stage = stage_of(bricks_far);
    shot = shot_of(&stage, 2, "auto", false);
    assert_int_equal(shot.frame.plan->rows[WR_EFFECT_FILTER].pixels, shot.frame.shaded);
    put_away(&shot);
    strike(&stage);
    stage = stage_of(bricks_near);
    shot = shot_of(&stage, 2, "auto", false);
    assert_int_equal(shot.frame.plan->rows[WR_EFFECT_FILTER].pixels, 0);
    put_away(&shot);
    strike(&stage);
}

/* S24: bumps where the face has any; near the letters only, on the level face never. */
static void each_face_has_a_plan_of_its_own(void **state)
{
    (void)state;
    Stage stage = stage_of(faces);
    Shot shot = shoot(stage.scene, stage.field, 400, 400, 2, "auto", false);
    int64_t of[6] = { 0 };
    for (int i = 0; i < 400 * 400; i++) {
        double u, v;
        int face;
        if (wr_renderer_pick(shot.renderer, i % 400 + 0.5, i / 400 + 0.5, &u, &v, &face))
            of[face]++;
    }
    const int64_t bumped = shot.frame.plan->rows[WR_EFFECT_BUMP].pixels;
    assert_int_equal(of[0] + of[3] + of[4], shot.frame.shaded);
    assert_true(of[3] > 5000 && of[4] > 5000);
    assert_in_range(bumped, of[0] * 3 / 4, of[0] + of[3] * 3 / 4);
    put_away(&shot);
    for (int k = 0; k < 300 * 300; k++)
        wr_field_set(stage.field, 40 + k % 300, 424 + k / 300, 0.25f);
    shot = shoot(stage.scene, stage.field, 400, 400, 2, "auto", false);
    assert_in_range(shot.frame.plan->rows[WR_EFFECT_BUMP].pixels, 500, of[3] * 3 / 4);
    put_away(&shot);
    strike(&stage);
}

/* S25: no sample of the hidden sphere is shaded; a part visible at the side is, with its colour texture. */
static void what_is_hidden_is_not_shaded(void **state)
{
    (void)state;
    Stage stage = stage_of(hidden_sphere);
    Shot both = shot_of(&stage, 2, "auto", false);
    stage.scene->others[0]->hidden = true;
    Shot front = shot_of(&stage, 2, "auto", false);
    assert_int_equal(both.frame.shaded, front.frame.shaded);
    assert_true(same_picture(&both, &front));
    stage.scene->others[0]->hidden = false;
    stage.scene->others[0]->at.x = 2.6;
    Shot aside = shot_of(&stage, 2, "auto", false);
    assert_true(aside.frame.shaded > front.frame.shaded);
    assert_true(aside.frame.plan->rows[WR_EFFECT_COLOUR].ran);
    put_away(&aside);
    put_away(&front);
    put_away(&both);
    strike(&stage);
}

/* S07: one sample per pixel inside the surface, all along its silhouette. */
static void a_ramp_is_refined_along_its_outline_alone(void **state)
{
    uint8_t map[200 * 200] = { 0 };
    WrFrame frame;
    (void)state;
    Stage stage = stage_of(ramp);
    WrPool *pool = wr_pool_new(2);
    WrRenderer *renderer = wr_renderer_new(pool, NULL, NULL);
    const WrFrameRequest request = {
        .field = stage.field, .scene = stage.scene, .width = 200, .height = 200, .map = map
    };
    assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
    int left = 200, right = 0, top = 200, bottom = 0, refined = 0, within = 0;
    for (int i = 0; i < 200 * 200; i++) {
        if (!(map[i] & WR_MAP_COVERED)) continue;
        left = i % 200 < left ? i % 200 : left, right = i % 200 > right ? i % 200 : right;
        top = i / 200 < top ? i / 200 : top, bottom = i / 200 > bottom ? i / 200 : bottom;
    }
    const int edge_x = 2 + (right - left) / 24, edge_y = 2 + (bottom - top) / 24;
    for (int i = 0; i < 200 * 200; i++) {
        const int x = i % 200, y = i / 200;
        const bool inside =
            x > left + edge_x && x < right - edge_x && y > top + edge_y && y < bottom - edge_y;
        refined += map[i] >= WR_MAP_SAMPLES;
        within += inside && map[i] >= WR_MAP_SAMPLES;
    }
    assert_true(refined > 100);
    assert_int_equal(within, 0);
    wr_renderer_free(renderer);
    wr_pool_free(pool);
    strike(&stage);
}

/* S29: another light does not rebuild tables. S30: a dab on the corner of the table affects four places. */
static void second_pictures_make_what_changed(void **state)
{
    WrFrame frame;
    uint8_t map[200 * 200];
    int corners[4] = { 0 }, drawn = 0;
    (void)state;
    Stage stage = stage_of(invariant_square);
    stage.scene->replicate_u = stage.scene->replicate_v = 1;
    stage.scene->posed = true;
    WrPool *pool = wr_pool_new(2);
    WrRenderer *renderer = wr_renderer_new(pool, NULL, NULL);
    WrFrameRequest request = { .field = stage.field,
                               .scene = stage.scene,
                               .width = 200,
                               .height = 200,
                               .keep = true,
                               .map = map };
    assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
    WrScene *lit = wr_scene_clone(stage.scene);
    lit->lights[0].where = (WrVec3){ 0.3, 0.2, 1 };
    request.scene = lit;
    assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
    assert_int_equal(renderer->table.texels_refreshed, 0);
    memset(map, 0, sizeof map);
    WrField *edited = wr_field_share(stage.field);
    wr_field_set(edited, 0, 0, 1);
    request.field = edited;
    assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
    assert_false(wr_plan_runs(frame.plan, WR_EFFECT_AGAIN));
    for (int i = 0; i < 200 * 200; i++)
        if (map[i] & WR_MAP_RENDERED) {
            drawn++;
            if (map[i] & WR_MAP_COVERED) corners[2 * (i / 200 >= 100) + (i % 200 >= 100)]++;
        }
    assert_in_range(drawn, 1, 200 * 200 - 1);
    for (int c = 0; c < 4; c++) assert_true(corners[c] > 0);
    wr_field_free(edited);
    wr_scene_free(lit);
    wr_renderer_free(renderer);
    wr_pool_free(pool);
    strike(&stage);
}

/* ---- smallest changes ------------------------------------------------------------------------------ */

static void least_texel(Stage *stage)
{
    wr_field_set(stage->field, 63, 63, nextafterf(0.25f, 1));
}

static void least_height(Stage *stage)
{
    stage->scene->height = 1e-30;
}

static void least_replication(Stage *stage)
{
    stage->scene->replicate_v = 1e-9;
}

static void least_light(Stage *stage)
{
    stage->scene->lights[0].strength = 1e-30;
}

static void least_diffuse(Stage *stage)
{
    stage->scene->material.diffuse = 1e-30;
}

static void least_colour(Stage *stage)
{
    stage->scene->colour->data[100] = nextafterf(1, 0);
}

static void least_side(Stage *stage)
{
    stage->scene->shape.value[1] = nextafter(1, 2);
}

static void last_replication(Stage *stage)
{
    stage->scene->replicate_u = 1024;
}

static void almost_replicated(Stage *stage)
{
    stage->scene->replicate_u = nextafter(1024, 0);
}

static void no_height(Stage *stage)
{
    stage->scene->height = 0;
}

static void no_light(Stage *stage)
{
    stage->scene->lights[0].strength = 0;
}

static void white(Stage *stage)
{
    WrImage *image = wr_image_new(8, 8, 3, NULL);
    for (int i = 0; i < 8 * 8 * 3; i++) image->data[i] = 1;
    stage->scene->colour = image;
}

static void checkered_texel(Stage *stage)
{
    wr_field_set(stage->field, 0, 0, nextafterf(0, 1));
}

static void what_is_left_out_comes_back_by_the_least_change(void **state)
{
    static const struct {
        WrEffect effect;
        Change without, with;
    } cases[] = {
        { WR_EFFECT_BUMP, flat_table, least_texel },
        { WR_EFFECT_BUMP, checkered, checkered_texel },
        { WR_EFFECT_BUMP, no_height, least_height },
        { WR_EFFECT_BUMP, still, least_replication },
        { WR_EFFECT_SPECULAR, no_highlight, least_highlight },
        { WR_EFFECT_DIFFUSE, only_highlight, least_diffuse },
        { WR_EFFECT_DIFFUSE, no_light, least_light },
        { WR_EFFECT_COLOUR, white, least_colour },
        { WR_EFFECT_INVARIANT, invariant_square, least_side },
        { WR_EFFECT_WIDE, almost_replicated, last_replication },
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Stage stage = stage_of(cases[i].without);
        for (int with = 0; with < 2; with++) {
            Shot shot = shot_of(&stage, 2, "auto", false);
            const WrPlanRow *row = &shot.frame.plan->rows[cases[i].effect];
            if (row->run != with || row->ran != with)
                fail_msg("%zu: %s %s: %s", i, row->name, with ? "is left out" : "runs",
                         row->reason);
            put_away(&shot);
            cases[i].with(&stage);
        }
        strike(&stage);
    }
}

/* ---- guide page ----------------------------------------------------------------------------------- */

/* The guide has a row for each scene, and marks those that need missing features. */
static void the_guide_lists_them(void **state)
{
    (void)state;
    char *page = NULL;
    size_t length;
    assert_true(wr_file_read(WR_SOURCE_DIR "/ui/guide/plan.md", 1 << 20, &page, &length, NULL));
    int awaiting = 0;
    for (int s = 1; s <= 32; s++) {
        char id[24];
        snprintf(id, sizeof id, "\n| S%02d |", s);
        const char *row = strstr(page, id);
        if (!row) fail_msg("no row%s", id);
        const char *end = strchr(row + 1, '\n'), *awaits = strstr(row, "awaits");
        bool there = s == 29 || s == 30;
        for (size_t i = 0; i < SCENES; i++)
            there |= strncmp(scenes[i].id, id + 3, 3) == 0 && scenes[i].change;
        if (there == (awaits && awaits < end)) fail_msg("S%02d: awaits or not?", s);
        awaiting += !there;
    }
    assert_int_equal(awaiting, 0);
    wr_free(page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_scene_runs_what_it_calls_for),
        cmocka_unit_test(all_forced_make_the_same_picture),
        cmocka_unit_test(effects_run_where_they_are_called_for),
        cmocka_unit_test(each_face_has_a_plan_of_its_own),
        cmocka_unit_test(what_is_hidden_is_not_shaded),
        cmocka_unit_test(a_ramp_is_refined_along_its_outline_alone),
        cmocka_unit_test(second_pictures_make_what_changed),
        cmocka_unit_test(what_is_left_out_comes_back_by_the_least_change),
        cmocka_unit_test(the_guide_lists_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
