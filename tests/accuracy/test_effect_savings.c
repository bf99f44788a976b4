/* test_effect_savings.c - costs and savings of effects are measured on frames in which they did and did not run. Times are
   not checked. */
#include "test.h"
#include "render/render_scenes.h"

#include "accuracy/effect_savings.h"

#define SIDE 48

typedef struct Stage {
    WrScene *scene;
    WrField *field;
    WrPool *pool;
    WrFrameRequest frame;
    WrSaving savings[WR_EFFECT_COUNT];
} Stage;

static void set_up(Stage *stage, const char *surface)
{
    *stage =
        (Stage){ .scene = scene_of(surface), .field = bumpy_field(64, 64), .pool = wr_pool_new(2) };
    stage->frame = (WrFrameRequest){
        .field = stage->field, .scene = stage->scene, .width = SIDE, .height = SIDE
    };
}

static void strike(Stage *stage)
{
    wr_scene_free(stage->scene);
    wr_field_free(stage->field);
    wr_pool_free(stage->pool);
}

static void measure(Stage *stage)
{
    WrError err = { "" };
    const WrSavingRequest ask = { .pool = stage->pool, .isa = "auto", .frame = &stage->frame };
    if (!wr_savings_measure(&ask, stage->savings, &err)) fail_msg("%s", err.text);
}

/* The plan with one effect forced, and the effects that ran: from a separate rendering. */
static WrPlan plan_of(const Stage *stage, WrEffect effect, WrForce how)
{
    WrForce force[WR_EFFECT_COUNT] = { WR_FORCE_NONE };
    WrFrame frame;
    WrFrameRequest request = stage->frame;
    WrRenderer *renderer = wr_renderer_new(stage->pool, "auto", NULL);
    force[effect] = how;
    request.force = force;
    assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
    const WrPlan plan = *frame.plan;
    wr_renderer_free(renderer);
    return plan;
}

static void check_row(const Stage *stage, WrEffect effect, const WrPlan *planned)
{
    const WrSaving *saving = &stage->savings[effect];
    const bool run = planned->rows[effect].run;
    const WrPlan other = plan_of(stage, effect, run ? WR_FORCE_OFF : WR_FORCE_ON);
    const bool turned = other.rows[effect].run != run && other.rows[effect].ran != run;
    if (saving->run != run) fail_msg("%s: it is said to run", wr_effects[effect].name);
    if (!saving->why_not != turned)
        fail_msg("%s: %s", wr_effects[effect].name, turned ? saving->why_not : "measured nothing");
    if (!turned) return;
    const WrPlanRow *with = run ? &planned->rows[effect] : &other.rows[effect];
    assert_int_equal(saving->tiles, with->tiles);
    assert_int_equal(saving->pixels, with->pixels);
    assert_true(saving->tiles > 0 && saving->pixels > 0 && saving->runs >= 3);
    assert_true(saving->spread >= 0 && saving->planned > 0 && saving->forced > 0);
    assert_true(saving->noise == (fabs(saving->seconds) <= saving->spread));
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        assert_true((saving->also >> e & 1) ==
                    (e != (int)effect && planned->rows[e].run != other.rows[e].run));
}

static void each_is_measured_where_it_can_be_turned(void **state)
{
    static const char *const surfaces[] = { "sphere", "torus", "plane" };
    (void)state;
    for (int k = 0; k < 6; k++) {
        Stage stage;
        set_up(&stage, surfaces[k % 3]);
        stage.scene->bump = k < 3 ? WR_BUMP_BLINN : WR_BUMP_EXACT;
        stage.scene->dials.aa = k < 3 ? WR_AA_MOMENTS : WR_AA_SUPERSAMPLE;
        stage.scene->dials.samples = 2;
        stage.scene->height = k == 0 ? 0 : stage.scene->height;
        measure(&stage);
        const WrPlan planned = plan_of(&stage, WR_EFFECT_AGAIN, WR_FORCE_NONE);
        for (int e = 0; e < WR_EFFECT_COUNT; e++) check_row(&stage, (WrEffect)e, &planned);
        strike(&stage);
    }
}

static void an_effect_goes_with_what_it_needs(void **state)
{
    Stage stage;
    (void)state;
    set_up(&stage, "sphere");
    stage.scene->bump = WR_BUMP_EXACT;
    measure(&stage);
    const WrSaving *exact = &stage.savings[WR_EFFECT_EXACT];
    assert_null(exact->why_not);
    assert_true(exact->also >> WR_EFFECT_CURVATURE & 1);
    assert_string_equal(stage.savings[WR_EFFECT_CURVATURE].why_not,
                        "cannot be forced: there is no picture without it");
    assert_string_equal(stage.savings[WR_EFFECT_HALF].why_not,
                        "cannot be forced: nothing in the scene needs it");
    strike(&stage);
}

/* The picture is empty: stages that never run have no cost. */
static void an_empty_picture_measures_nothing(void **state)
{
    Stage stage;
    (void)state;
    set_up(&stage, "sphere");
    stage.scene->camera.orthographic = stage.scene->camera.fit = false;
    stage.scene->camera.eye = (WrVec3){ 0, 0, 10 };
    stage.scene->camera.target = (WrVec3){ 0, 0, 20 };
    measure(&stage);
    assert_non_null(stage.savings[WR_EFFECT_BUMP].why_not);
    assert_non_null(strstr(stage.savings[WR_EFFECT_BUMP].why_not, "no pixel"));
    strike(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_is_measured_where_it_can_be_turned),
        cmocka_unit_test(an_effect_goes_with_what_it_needs),
        cmocka_unit_test(an_empty_picture_measures_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
