/* Gestures in a window without a display: effect of drags and actions on the document. */
#include "test.h"

#include "test_app.h"

#include "document/document.h"
#include "field/field.h"
#include "scene/scene.h"
#include "surface/surface.h"

#include "ui/canvas/canvas.h"
#include "ui/canvas/view.h"
#include "ui/state/action.h"
#include "ui/state/input_router.h"
#include "ui/state/layout.h"
#include "ui/state/roster.h"
#include "ui/state/session_view.h"
#include "ui/state/settings.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_cube.h"
#include "ui/patch/patch_paint.h"
#include "ui/tools/stroke_input.h"
#include "ui/tools/tool_transform.h"

#include <math.h>
#include <string.h>

static void run(Bench *bench, const char *line)
{
    WrError err = { "" };
    if (!wr_session_run(bench->session, line, &err)) fail_msg("%s: %s", line, err.text);
}

static const WrDocument *document_of(const Bench *bench)
{
    return wr_session_document(bench->session);
}

/* Run the main loop until no command runs. */
static void settle(Bench *bench)
{
    for (int i = 0; i < 6; i++) draw_again(bench->app);
    double end = wr_clock_seconds() + PATIENCE;
    while ((bench->app->busy || bench->app->brush->jobs.count > 0) && wr_clock_seconds() < end)
        wr_app_step(bench->app);
    assert_null(bench->app->busy);
}

static void drag(Bench *bench, double x, double y, int dx, int dy)
{
    WrApp *app = bench->app;
    push_motion(app, (int)x, (int)y);
    draw_again(app);
    push_button(app, true, SDL_BUTTON_LEFT, (int)x, (int)y);
    draw_again(app);
    for (int i = 1; i <= 8; i++) {
        push_motion(app, (int)x + dx * i / 8, (int)y + dy * i / 8);
        draw_again(app);
    }
    push_button(app, false, SDL_BUTTON_LEFT, (int)x + dx, (int)y + dy);
    settle(bench);
}

/* Position of the light on the patch. */
static bool find_lamp(const WrApp *app, WrPointer *out)
{
    const SDL_Rect *r = &app->layout->patch;
    for (int y = r->y + 2; y < r->y + r->h; y += 4)
        for (int x = r->x + 2; x < r->x + r->w; x += 4) {
            *out = (WrPointer){ .x = x, .y = y, .button = SDL_BUTTON_LEFT };
            if (wr_patch_control_under(app, out) && !wr_patch_cube_under(app, out)) return true;
        }
    return false;
}

static void a_lamp_is_dragged_while_the_patch_is_painted_on(void **state)
{
    (void)state;
    Bench bench;
    WrPointer lamp;
    begin(&bench);
    run(&bench, "light directional to=-0.5,0.6,0.75 size=3 shadow=off index=1");
    bench.app->paint->on = true;
    settle(&bench);
    const int before = wr_session_history_position(bench.session);
    assert_true(find_lamp(bench.app, &lamp));
    drag(&bench, lamp.x + 4, lamp.y + 4, 40, 30);
    assert_int_equal(wr_session_history_position(bench.session), before + 1);
    const WrLight *light = &document_of(&bench)->scene->lights[0];
    assert_true(strncmp(wr_session_last_command(bench.session), "light directional", 17) == 0);
    assert_true(light->where.x != -0.5 && light->size_deg == 3 && !light->shadow);
    /* beside the light the brush paints */
    const SDL_Rect *r = &bench.app->layout->patch;
    drag(&bench, r->x + r->w / 2.0, r->y + r->h / 2.0, 10, 5);
    assert_true(strncmp(wr_session_last_command(bench.session), "stroke", 6) == 0);
    finish(&bench);
}

static void a_transform_frame_is_that_of_the_content(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    run(&bench, "layer add");
    run(&bench, "dab 0.25,0.25 radius=5 hardness=1"); /* about texel 16, 48 from the top */
    wr_action_run(bench.app, "transform");
    settle(&bench);
    WrTransformState *hand = bench.app->transform;
    assert_in_range(hand->box.i, 9, 11);
    assert_in_range(hand->box.j, 41, 43);
    assert_in_range(hand->box.count_i, 10, 13);
    assert_in_range(hand->box.count_j, 10, 13);
    /* scaled about the frame's middle, it stays there */
    const WrField *field = wr_document_field(document_of(&bench));
    assert_true(wr_field_get(field, 16, 40) == 0.0f && wr_field_get(field, 16, 47) > 0.0f);
    hand->now.scale[0] = hand->now.scale[1] = 2.0;
    SDL_PushEvent(&(SDL_Event){
        .key = { .type = SDL_KEYDOWN,
                 .windowID = SDL_GetWindowID(bench.app->window),
                 .keysym = { .scancode = SDL_SCANCODE_RETURN, .sym = SDLK_RETURN } } });
    settle(&bench);
    field = wr_document_field(document_of(&bench));
    assert_true(wr_field_get(field, 16, 40) > 0.0f && wr_field_get(field, 16, 56) > 0.0f);
    assert_true(wr_field_get(field, 8, 48) > 0.0f && wr_field_get(field, 24, 48) > 0.0f);
    assert_true(wr_field_get(field, 32, 32) == 0.0f);
    run(&bench, "select rect from=0.5,0.5 to=0.75,0.75");
    settle(&bench);
    assert_in_range(hand->box.count_i, 16, 16);
    finish(&bench);
}

static void what_is_copied_comes_back_in_its_place(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    run(&bench, "noise value cells=9 seed=2");
    run(&bench, "select rect from=0.25,0.5 to=0.5,0.75");
    wr_action_run(bench.app, "copy");
    settle(&bench);
    run(&bench, "select rect from=0.6,0.1 to=0.7,0.2"); /* elsewhere */
    const int before = wr_session_history_position(bench.session);
    WrField *was = wr_field_share(wr_document_field(document_of(&bench)));
    wr_action_run(bench.app, "paste");
    settle(&bench);
    const WrDocument *document = document_of(&bench);
    assert_int_equal(wr_session_history_position(bench.session), before + 1);
    assert_int_equal(document->layer_count, 2);
    assert_null(document->selection);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) {
            const bool inside = i >= 16 && i < 32 && j >= 16 && j < 32;
            assert_true((wr_field_get(document->layers[1].cover, i, j) == 1.0f) == inside);
            assert_true(wr_field_get(wr_document_field(document), i, j) == wr_field_get(was, i, j));
        }
    wr_action_run(bench.app, "undo");
    settle(&bench);
    assert_int_equal(document_of(&bench)->layer_count, 1);
    assert_non_null(document_of(&bench)->selection);
    wr_field_free(was);
    finish(&bench);
}

/* The brush's strength is a height; a mask ranges from 0 to 1 for any heights. */
static void a_stroke_on_a_mask_hides_in_full(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    run(&bench, "layer add");
    run(&bench, "fill 0.01");
    run(&bench, "layer mask 2 from=white");
    run(&bench, "layer use 2 part=mask");
    WrBrush *brush = &bench.app->settings->brush;
    brush->strength = 0.004;
    brush->radius = 6;
    brush->hardness = 1;
    brush->mode = WR_BRUSH_LOWER;
    wr_action_run(bench.app, "brush");
    settle(&bench);
    double x, y;
    wr_view_to_pixel(bench.app->view, 32, 32, &x, &y);
    drag(&bench, x, y, 6, 0);
    const WrLayer *layer = &document_of(&bench)->layers[1];
    assert_true(wr_field_get(layer->mask, 32, 32) == 0.0f);
    assert_true(wr_field_get(layer->mask, 2, 2) == 1.0f);
    run(&bench, "layer use 2 part=heights");
    settle(&bench);
    drag(&bench, x, y, 6, 0);
    layer = &document_of(&bench)->layers[1];
    assert_float_equal(wr_field_get(layer->heights, 32, 32), 0.006, 1e-6);
    finish(&bench);
}

static void a_hovering_stamp_leaves_the_greys_alone(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    run(&bench, "noise value cells=5 amplitude=0.5 level=0.5");
    settle(&bench);
    const double low = bench.app->range->low, high = bench.app->range->high;
    bench.app->settings->brush.strength = 3.0;
    wr_action_run(bench.app, "stamp");
    double x, y;
    wr_view_to_pixel(bench.app->view, 32, 32, &x, &y);
    for (int i = 0; i < 6; i++) {
        push_motion(bench.app, (int)x + i, (int)y);
        settle(&bench);
        assert_true(bench.app->range->low == low && bench.app->range->high == high);
    }
    /* a stroke below the lowest height moves black, and white stays */
    wr_action_run(bench.app, "brush");
    bench.app->settings->brush.mode = WR_BRUSH_LOWER;
    bench.app->settings->brush.strength = 1.0;
    drag(&bench, x, y, 6, 0);
    assert_true(bench.app->range->low < low && bench.app->range->high == high);
    finish(&bench);
}

/* Cosine of the angle between the plane's normal, its z axis, and the direction to the eye. */
static double facing(const Bench *bench)
{
    WrPlacement place;
    WrError err;
    const WrScene *scene = document_of(bench)->scene;
    if (!wr_scene_place(scene, bench->app->patch->turn_deg, 1.0, &place, &err))
        fail_msg("%s", err.text);
    return -(place.rotation[2] * place.forward.x + place.rotation[5] * place.forward.y +
             place.rotation[8] * place.forward.z);
}

/* Also after the object before it has turned; from the side the cosine is 0, from the back below 0. */
static void a_photo_is_seen_from_its_front(void **state)
{
    (void)state;
    static const double turns[] = { 0.0, 90.0, 180.0, 271.0 };
    for (size_t i = 0; i < sizeof turns / sizeof *turns; i++) {
        Bench bench;
        begin(&bench);
        bench.app->settings->turning = false;
        bench.app->patch->turn_deg = turns[i];
        wr_app_open_path(bench.app, WR_SOURCE_DIR "/samples/wood-diffuse.jpg");
        settle(&bench);
        settle(&bench);
        assert_string_equal(wr_surfaces[document_of(&bench)->scene->shape.kind]->name, "plane");
        assert_true(facing(&bench) > 0.8);
        finish(&bench);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_is_dragged_while_the_patch_is_painted_on),
        cmocka_unit_test(a_transform_frame_is_that_of_the_content),
        cmocka_unit_test(what_is_copied_comes_back_in_its_place),
        cmocka_unit_test(a_stroke_on_a_mask_hides_in_full),
        cmocka_unit_test(a_hovering_stamp_leaves_the_greys_alone),
        cmocka_unit_test(a_photo_is_seen_from_its_front),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}
