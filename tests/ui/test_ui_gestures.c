/* Gestures in a window without a display: effect of drags and actions on the document; drags of every tool and place that are
   interrupted by keys, buttons, the wheel and the window system. */
#include "test.h"

#include "app.h"

#include "document/document.h"
#include "field/field.h"
#include "scene/scene.h"
#include "surface/surface.h"

#include "ui/canvas/canvas.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/dropped_files.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/panels/layer_choice.h"
#include "ui/panels/panel_search.h"
#include "ui/panels/search_index.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_cube.h"
#include "ui/patch/patch_paint.h"
#include "ui/app/jobs/edit_preview.h"
#include "ui/toolkit/focus.h"
#include "ui/toolkit/gui.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"
#include "ui/canvas/tools/tool_transform.h"

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

static void push_key(const WrApp *app, SDL_Keycode sym, SDL_Keymod mod)
{
    SDL_KeyboardEvent event = {
        .windowID = SDL_GetWindowID(app->window),
        .keysym = { .scancode = SDL_GetScancodeFromKey(sym), .sym = sym, .mod = mod }
    };
    SDL_SetModState(mod);
    event.type = SDL_KEYDOWN;
    SDL_PushEvent(&(SDL_Event){ .key = event });
    event.type = SDL_KEYUP;
    SDL_PushEvent(&(SDL_Event){ .key = event });
    SDL_SetModState(KMOD_NONE);
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
    push_key(bench.app, SDLK_RETURN, KMOD_NONE);
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

/* The frame of two chosen layers is around both, also across the edge; a key and Enter move both in one step. */
static void several_chosen_layers_are_transformed_together(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    run(&bench, "table 97x61");
    run(&bench, "layer add low");
    run(&bench, "dab 0.5,0.25 radius=5 hardness=1"); /* columns 43..54 */
    run(&bench, "layer add high");
    run(&bench, "dab 0.01,0.75 radius=6 hardness=1"); /* columns -6..7 */
    settle(&bench);
    wr_action_run(bench.app, "transform");
    settle(&bench);
    const WrTransformState *hand = bench.app->transform;
    assert_in_range(hand->box.i, 90, 93);
    assert_in_range(hand->box.count_i, 12, 15);
    wr_layer_pick(bench.app, 1, WR_CHOOSE_TOGGLE);
    settle(&bench);
    assert_in_range(hand->box.i, 90, 93); /* to column 54 */
    assert_in_range(hand->box.i + hand->box.count_i, 97 + 53, 97 + 55);
    assert_in_range(hand->box.count_j, 40, 44); /* rows 9..51 */
    const WrDocument *document = document_of(&bench);
    WrField *old[] = { wr_field_share(document->layers[1].heights),
                       wr_field_share(document->layers[2].heights) };
    const int before = wr_session_history_position(bench.session);
    push_key(bench.app, SDLK_RIGHT, KMOD_NONE);
    push_key(bench.app, SDLK_UP, KMOD_NONE);
    push_key(bench.app, SDLK_RIGHT, KMOD_NONE);
    settle(&bench);
    push_key(bench.app, SDLK_RETURN, KMOD_NONE);
    settle(&bench);
    assert_int_equal(wr_session_history_position(bench.session), before + 1);
    assert_string_equal(wr_session_last_command(bench.session), "transform move=2,1 of=2,3");
    document = document_of(&bench);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 97 * 61; i++)
            assert_true(wr_field_get(document->layers[k + 1].heights, (i % 97 + 2) % 97,
                                     (i / 97 + 60) % 61) == wr_field_get(old[k], i % 97, i / 97));
        wr_field_free(old[k]);
    }
    finish(&bench);
}

/* Drag the frame's middle by that many texels; returns the move. */
static double drag_frame(Bench *bench, double texels, int mods)
{
    const WrTransformState *hand = bench->app->transform;
    WrCanvasView *view = bench->app->view;
    double x, y,
        middle[2] = { hand->box.i + 0.5 * hand->box.count_i,
                      hand->box.j + 0.5 * hand->box.count_j };
    view->zoom = 3.0;
    view->centre_x = middle[0] + 0.5 * texels;
    view->centre_y = middle[1];
    wr_view_place(view, middle[0], middle[1], &x, &y);
    bench->app->hand->mods = mods;
    drag(bench, x, y, (int)rint(texels * view->zoom), 0);
    bench->app->hand->mods = 0;
    return hand->now.move[0];
}

static void a_dragged_frame_snaps_to_a_third_of_the_cell(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    run(&bench, "table 197x161");
    run(&bench, "layer add");
    run(&bench, "dab 0.15,0.5 radius=10 hardness=1");
    wr_action_run(bench.app, "transform");
    settle(&bench);
    const WrTransformState *hand = bench.app->transform;
    const WrField *was = document_of(&bench)->layers[1].heights;
    const double left = hand->box.i, way = 65.67 - 1.25 - left; /* a third is 65.67 */
    assert_true(drag_frame(&bench, way, 0) == 66 - left);
    push_key(bench.app, SDLK_ESCAPE, KMOD_NONE);
    settle(&bench);
    assert_true(drag_frame(&bench, way, WR_MOD_CTRL) == 64 - left);
    push_key(bench.app, SDLK_ESCAPE, KMOD_NONE);
    bench.app->settings->snap = false;
    settle(&bench);
    assert_true(drag_frame(&bench, way, 0) == 64 - left);
    push_key(bench.app, SDLK_ESCAPE, KMOD_NONE);
    settle(&bench);
    assert_true(drag_frame(&bench, way, WR_MOD_CTRL) == 66 - left);
    assert_ptr_equal(document_of(&bench)->layers[1].heights, was); /* only a preview so far */
    push_key(bench.app, SDLK_ESCAPE, KMOD_NONE);
    settle(&bench);
    drag_frame(&bench, 41, WR_MOD_ALT); /* a copy */
    push_key(bench.app, SDLK_RETURN, KMOD_NONE);
    settle(&bench);
    assert_string_equal(wr_session_last_command(bench.session), "transform move=41,0 leave=on");
    const WrField *now = document_of(&bench)->layers[1].heights;
    assert_true(wr_field_get(now, 30, 80) > 0.0f);
    assert_true(wr_field_get(now, 71, 80) == wr_field_get(now, 30, 80));
    assert_true(wr_field_get(now, 50, 80) == 0.0f);
    finish(&bench);
}

static void push_drop(const char *file)
{
    SDL_PushEvent(&(SDL_Event){ .drop = { .type = SDL_DROPFILE, .file = SDL_strdup(file) } });
}

/* A drop of two pictures opens one dialog; the likely use is a layer for heights, normals for a normal map. */
static void dropped_pictures_are_asked_about_once(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    run(&bench, "table 97x61");
    run(&bench, "noise value cells=7 seed=5");
    run(&bench, "export height grey.png");
    run(&bench, "export normal+y normals.png");
    const int before = wr_session_history_position(bench.session);
    push_drop("grey.png");
    push_drop("normals.png");
    settle(&bench);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_DROP);
    assert_int_equal(bench.app->dropped->paths.count, 2);
    assert_int_equal(bench.app->dropped->guess, WR_DROP_LAYER);
    push_key(bench.app, SDLK_ESCAPE, KMOD_NONE);
    settle(&bench);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_NONE);
    assert_int_equal(wr_session_history_position(bench.session), before);
    push_drop("grey.png");
    push_drop("normals.png");
    settle(&bench);
    push_key(bench.app, SDLK_RETURN, KMOD_NONE);
    settle(&bench);
    assert_int_equal(document_of(&bench)->layer_count, 3);
    assert_ptr_equal(wr_tool_now(bench.app), &wr_tool_transform);
    push_drop("normals.png");
    settle(&bench);
    assert_int_equal(bench.app->dropped->guess, WR_DROP_NORMALS);
    push_key(bench.app, SDLK_RETURN, KMOD_NONE);
    settle(&bench);
    const WrDocument *document = document_of(&bench);
    assert_int_equal(document->layer_count, 4);
    assert_non_null(document->layers[3].line);
    assert_memory_equal(document->layers[3].line, "picture normals", 15);
    finish(&bench);
}

static void the_use_of_a_picture_is_guessed(void **state)
{
    (void)state;
    static const struct {
        int width, height;
        bool floats;
        uint8_t rgb[6];
        WrDropUse use;
    } cases[] = {
        { 200, 100, true, { 90, 120, 200, 60, 50, 40 }, WR_DROP_SURROUND },
        { 201, 100, true, { 90, 120, 200, 60, 50, 40 }, WR_DROP_COLOUR },
        { 200, 100, false, { 90, 120, 200, 60, 50, 40 }, WR_DROP_COLOUR },
        { 200, 100, true, { 90, 90, 90, 60, 60, 60 }, WR_DROP_LAYER },
        { 33, 77, false, { 250, 250, 250, 7, 7, 8 }, WR_DROP_LAYER },
        { 33, 77, false, { 160, 100, 240, 100, 150, 230 }, WR_DROP_NORMALS },
        { 33, 77, false, { 20, 60, 240, 30, 50, 230 }, WR_DROP_COLOUR },
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_int_equal(
            wr_drop_guess(cases[k].width, cases[k].height, cases[k].floats, cases[k].rgb, 2),
            cases[k].use);
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
    const int tool = bench.app->tool;
    wr_action_run(bench.app, "paste");
    settle(&bench);
    const WrDocument *document = document_of(&bench);
    /* the frame is about it until Enter */
    assert_ptr_equal(wr_tool_now(bench.app), &wr_tool_transform);
    const WrSelectBox *box = &bench.app->transform->box;
    assert_true(box->i == 16 && box->j == 16 && box->count_i == 16 && box->count_j == 16);
    push_key(bench.app, SDLK_RETURN, KMOD_NONE);
    settle(&bench);
    assert_int_equal(bench.app->tool, tool);
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
    /* a stroke below the lowest height moves black when it has ended, and white stays */
    wr_action_run(bench.app, "brush");
    bench.app->settings->brush.mode = WR_BRUSH_LOWER;
    bench.app->settings->brush.strength = 1.0;
    push_button(bench.app, true, SDL_BUTTON_LEFT, (int)x, (int)y);
    for (int i = 0; i < 6; i++) {
        push_motion(bench.app, (int)x + i, (int)y);
        draw_again(bench.app);
        assert_true(bench.app->range->low == low && bench.app->range->high == high);
    }
    assert_true(bench.app->range->table_low < low); /* the stroke is there */
    push_button(bench.app, false, SDL_BUTTON_LEFT, (int)x + 5, (int)y);
    settle(&bench);
    assert_true(bench.app->range->low < low && bench.app->range->high == high);
    finish(&bench);
}

static void settle_preview(Bench *bench)
{
    const double end = wr_clock_seconds() + PATIENCE;
    settle(bench);
    while (wr_edit_preview_busy(bench->app->trial, NULL, NULL) && wr_clock_seconds() < end)
        wr_app_step(bench->app);
    settle(bench);
}

/* A generator's preview is higher than the table: the greys make room for it, once, and none when it is cancelled. */
static void a_generators_preview_leaves_the_greys_as_they_were(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    const int tab = bench.app->settings->tab;
    run(&bench, "noise value cells=5 amplitude=0.01 level=0.015");
    settle(&bench);
    const WrCanvasRange before = *bench.app->range;
    wr_action_run(bench.app, "generate_noise_perlin");
    settle_preview(&bench);
    const WrCanvasRange tried = *bench.app->range;
    assert_true(bench.app->trying && tried.high > before.high && tried.low <= before.low);
    double x, y;
    wr_view_to_pixel(bench.app->view, 32, 32, &x, &y);
    for (int i = 0; i < 4; i++) {
        push_motion(bench.app, (int)x + 9 * i, (int)y);
        settle_preview(&bench);
        assert_true(bench.app->range->low == tried.low && bench.app->range->high == tried.high);
    }
    wr_generate_cancel(bench.app);
    settle(&bench);
    assert_true(bench.app->range->low == before.low && bench.app->range->high == before.high);
    wr_action_run(bench.app, "brush");
    bench.app->settings->tab = tab;
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

/* ---- interrupted drags ---- */

static int complaints;

static void complain(const char *where, const char *what, const char *detail)
{
    complaints++;
    printf("%s: %s: %s\n", where, what, detail);
}

static void push_wheel(const WrApp *app, int steps)
{
    SDL_PushEvent(&(SDL_Event){ .wheel = { .type = SDL_MOUSEWHEEL,
                                           .windowID = SDL_GetWindowID(app->window),
                                           .y = steps,
                                           .preciseY = (float)steps } });
}

static void push_window(const WrApp *app, SDL_WindowEventID id, int a, int b)
{
    SDL_PushEvent(&(SDL_Event){ .window = { .type = SDL_WINDOWEVENT,
                                            .windowID = SDL_GetWindowID(app->window),
                                            .event = (Uint8)id,
                                            .data1 = a,
                                            .data2 = b } });
}

typedef enum Break {
    BREAK_NONE,
    BREAK_WHEEL,
    BREAK_RESIZE,
    BREAK_FOCUS_LOST,
    BREAK_LEAVE,
    BREAK_HIDDEN,
    BREAK_RIGHT,
    BREAK_MIDDLE,
    BREAK_LEFT_AGAIN,
    BREAK_KEYS /* the first key */
} Break;

static const struct {
    const char *name;
    SDL_Keycode sym;
    SDL_Keymod mod;
} keys[] = {
    { "Escape", SDLK_ESCAPE, KMOD_NONE },
    { "Ctrl+Z", SDLK_z, KMOD_LCTRL },
    { "Ctrl+Shift+Z", SDLK_z, KMOD_LCTRL | KMOD_LSHIFT },
    { "Return", SDLK_RETURN, KMOD_NONE },
    { "Delete", SDLK_DELETE, KMOD_NONE },
    { "Tab", SDLK_TAB, KMOD_NONE },
    { "Space", SDLK_SPACE, KMOD_NONE },
    { "F3", SDLK_F3, KMOD_NONE },
    { "F4", SDLK_F4, KMOD_NONE },
    { "B", SDLK_b, KMOD_NONE },
    { "Ctrl+T", SDLK_t, KMOD_LCTRL },
    { "Ctrl+A", SDLK_a, KMOD_LCTRL },
    { "Ctrl+J", SDLK_j, KMOD_LCTRL },
    { "Ctrl+X", SDLK_x, KMOD_LCTRL },
    { "Ctrl+V", SDLK_v, KMOD_LCTRL },
    { "Ctrl+N", SDLK_n, KMOD_LCTRL },
    { "Ctrl+M", SDLK_m, KMOD_LCTRL },
    { "]", SDLK_RIGHTBRACKET, KMOD_NONE },
    { "X", SDLK_x, KMOD_NONE },
    { "F1", SDLK_F1, KMOD_NONE },
    { "Ctrl+Shift+N", SDLK_n, KMOD_LCTRL | KMOD_LSHIFT },
    { "Page down", SDLK_PAGEDOWN, KMOD_NONE },
};
enum { BREAKS = BREAK_KEYS + sizeof keys / sizeof *keys };

static const char *break_name(int which)
{
    static const char *const names[] = { "nothing", "wheel", "resize", "focus lost", "pointer out",
                                         "hidden",  "right", "middle", "left again" };
    return which < BREAK_KEYS ? names[which] : keys[which - BREAK_KEYS].name;
}

static void interrupt(WrApp *app, int which, int x, int y)
{
    switch (which) {
    case BREAK_NONE: return;
    case BREAK_WHEEL: push_wheel(app, 2); return;
    case BREAK_RESIZE: SDL_SetWindowSize(app->window, 700, 620); return;
    case BREAK_FOCUS_LOST: push_window(app, SDL_WINDOWEVENT_FOCUS_LOST, 0, 0); return;
    case BREAK_LEAVE: push_window(app, SDL_WINDOWEVENT_LEAVE, 0, 0); return;
    case BREAK_HIDDEN:
        push_window(app, SDL_WINDOWEVENT_HIDDEN, 0, 0);
        push_window(app, SDL_WINDOWEVENT_SHOWN, 0, 0);
        return;
    case BREAK_RIGHT:
        push_button(app, true, SDL_BUTTON_RIGHT, x, y);
        push_button(app, false, SDL_BUTTON_RIGHT, x, y);
        return;
    case BREAK_MIDDLE:
        push_button(app, true, SDL_BUTTON_MIDDLE, x, y);
        push_button(app, false, SDL_BUTTON_MIDDLE, x, y);
        return;
    case BREAK_LEFT_AGAIN: push_button(app, true, SDL_BUTTON_LEFT, x, y); return;
    default: push_key(app, keys[which - BREAK_KEYS].sym, keys[which - BREAK_KEYS].mod);
    }
}

static void broken_drag(Bench *bench, double x, double y, int dx, int dy, int which)
{
    WrApp *app = bench->app;
    push_motion(app, (int)x, (int)y);
    draw_again(app);
    push_button(app, true, SDL_BUTTON_LEFT, (int)x, (int)y);
    draw_again(app);
    for (int i = 1; i <= 6; i++) {
        push_motion(app, (int)x + dx * i / 6, (int)y + dy * i / 6);
        draw_again(app);
        if (i != 3) continue;
        interrupt(app, which, (int)x + dx / 2, (int)y + dy / 2);
        draw_again(app);
    }
    push_button(app, false, SDL_BUTTON_LEFT, (int)x + dx, (int)y + dy);
    settle(bench);
}

static void see_errors(Bench *bench, const char *where)
{
    WrMessages *messages = bench->app->messages;
    for (int i = 0; i < messages->list.count; i++)
        if (messages->list.data[i].bad) complain(where, "error", messages->list.data[i].text);
    wr_messages_free(messages);
    *messages = (WrMessages){ 0 };
}

/* The document before a drag. Its view is not a part of the history. */
typedef struct Base {
    int position;
    int layers;
    WrField *heights; /* owned */
} Base;

static Base base_of(const Bench *bench)
{
    return (Base){ .position = wr_session_history_position(bench->session),
                   .layers = document_of(bench)->layer_count,
                   .heights = wr_field_share(wr_document_field(document_of(bench))) };
}

static bool is_base(const Bench *bench, const Base *base)
{
    const WrDocument *document = document_of(bench);
    const WrField *now = wr_document_field(document);
    bool same = document->layer_count == base->layers && !document->selection &&
                wr_field_width(now) == 64 && wr_field_height(now) == 64;
    for (int i = 0; same && i < 64 * 64; i++)
        same = wr_field_get(now, i % 64, i / 64) == wr_field_get(base->heights, i % 64, i / 64);
    return same;
}

static void rebuild(Bench *bench, Base *base)
{
    static const char *const lines[] = { "table 64x64", "surface torus",
                                         "noise value cells=5 amplitude=0.5", "layer add",
                                         "dab 0.5,0.5 radius=12" };
    wr_field_free(base->heights);
    wr_session_reset(bench->session);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) run(bench, lines[i]);
    wr_app_changed_document(bench->app);
    settle(bench);
    *base = base_of(bench);
}

/* What holds after any drag: no error, nothing held, and undo leads back to the same document. */
static void see_state(Bench *bench, const char *where, Base *base, bool cancelled)
{
    const int before = base->position;
    WrApp *app = bench->app;
    WrError err = { "" };
    char text[120];
    see_errors(bench, where);
    if (app->hand->grab != WR_GRAB_NONE) complain(where, "held", "after the release");
    for (int i = 0; i < 3 && app->dialog->now != WR_DIALOG_NONE; i++) wr_dialog_close(app);
    wr_tool_choose(app, 0);
    wr_app_try_end(app);
    settle(bench);
    wr_app_settle(app);
    const int now = wr_session_history_position(bench->session);
    snprintf(text, sizeof text, "%d steps, the last is %.80s", now - before,
             wr_session_last_command(bench->session));
    if (cancelled && now != before) complain(where, "Escape left a change", text);
    if (now > before + 3) complain(where, "many steps", text);
    if (now != before && !wr_session_history_go(bench->session, before, &err))
        complain(where, "no way back", err.text);
    settle(bench);
    if (!is_base(bench, base)) {
        complain(where, "another document", text);
        rebuild(bench, base);
    }
    see_errors(bench, where);
}

static void restore_window(Bench *bench)
{
    WrApp *app = bench->app;
    SDL_SetWindowSize(app->window, 900, 700);
    app->settings->panels = true;
    wr_action_run(app, "view_both");
    wr_action_run(app, "fit");
    app->paint->on = false;
    push_motion(app, 2, 2);
    settle(bench);
}

/* All pairs with WR_FULL, else each thirteenth; Escape and undo always. */
static bool is_tried(int a, int b)
{
    return (a + b) % 13 == 0 || b == BREAK_KEYS || b == BREAK_KEYS + 1 || getenv("WR_FULL");
}

static void every_tool_survives_every_interruption(void **state)
{
    (void)state;
    Bench bench;
    int tries = 0;
    complaints = 0;
    begin(&bench);
    WrApp *app = bench.app;
    app->settings->turning = false;
    Base base = { .heights = NULL };
    rebuild(&bench, &base);
    for (int tool = 0; tool < app->registry->tool_count; tool++)
        for (int which = 0; which < BREAKS; which++) {
            char where[120];
            double x0, y0, x1, y1;
            if (!is_tried(tool, which)) continue;
            snprintf(where, sizeof where, "%s, %s", app->registry->tools[tool]->action,
                     break_name(which));
            restore_window(&bench);
            wr_tool_choose(app, tool);
            settle(&bench);
            wr_view_to_pixel(app->view, 16, 40, &x0, &y0);
            wr_view_to_pixel(app->view, 40, 24, &x1, &y1);
            broken_drag(&bench, x0, y0, (int)(x1 - x0), (int)(y1 - y0), which);
            /* a tool without a drag acts at the press */
            const bool drags = app->registry->tools[tool]->drag != NULL;
            see_state(&bench, where, &base, drags && which == BREAK_KEYS);
            tries++;
        }
    printf("%d drags\n", tries);
    wr_field_free(base.heights);
    finish(&bench);
    assert_int_equal(complaints, 0);
}

/* Places of the window where drags begin; false: it is not there. */
typedef bool Place(Bench *bench, double *x, double *y);

static bool middle_of(const SDL_Rect *r, double *x, double *y)
{
    *x = r->x + r->w / 2.0;
    *y = r->y + r->h / 2.0;
    return r->w > 0 && r->h > 0;
}

static bool on_patch(Bench *bench, double *x, double *y)
{
    return middle_of(&bench->app->layout->patch, x, y);
}

static bool on_painted_patch(Bench *bench, double *x, double *y)
{
    bench->app->paint->on = true;
    settle(bench);
    return middle_of(&bench->app->layout->patch, x, y);
}

static bool on_lamp(Bench *bench, double *x, double *y)
{
    WrPointer lamp;
    if (!find_lamp(bench->app, &lamp)) return false;
    *x = lamp.x + 4;
    *y = lamp.y + 4;
    return true;
}

static bool on_divider(Bench *bench, double *x, double *y)
{
    return middle_of(&bench->app->layout->divider, x, y);
}

static bool on_panel_divider(Bench *bench, double *x, double *y)
{
    return middle_of(&bench->app->layout->panel_divider, x, y);
}

/* The first widget of that kind in the panels at the right, below the row of the tool's options, whose width depends on
   what is loaded. */
static bool on_widget(Bench *bench, WrKeyStopKind kind, double *x, double *y)
{
    int count;
    const WrKeyStop *stops = wr_gui_stops(bench->app->gui, &count);
    const SDL_Rect *panel = &bench->app->layout->panel;
    for (int i = 0; i < count; i++) {
        if (stops[i].kind != kind || stops[i].x0 < panel->x || stops[i].y0 < panel->y) continue;
        *x = 0.5 * (double)(stops[i].x0 + stops[i].x1);
        *y = 0.5 * (double)(stops[i].y0 + stops[i].y1);
        return true;
    }
    return false;
}

static bool on_number(Bench *bench, double *x, double *y)
{
    wr_tab_show(bench->app, "Scene");
    settle(bench);
    return on_widget(bench, WR_STOP_NUMBER, x, y);
}

static bool on_layer(Bench *bench, double *x, double *y)
{
    if (!on_widget(bench, WR_STOP_ROW, x, y)) return false;
    *x += 30;
    return true;
}

static bool on_menu(Bench *bench, double *x, double *y)
{
    (void)bench;
    *x = 20;
    *y = 10;
    return true;
}

static const struct {
    const char *name;
    Place *find;
} places[] = { { "patch", on_patch },
               { "painted patch", on_painted_patch },
               { "lamp", on_lamp },
               { "divider", on_divider },
               { "panels", on_panel_divider },
               { "number", on_number },
               { "layer", on_layer },
               { "menu", on_menu } };

static void every_place_survives_every_interruption(void **state)
{
    (void)state;
    Bench bench;
    int tries = 0;
    complaints = 0;
    begin(&bench);
    WrApp *app = bench.app;
    app->settings->turning = false;
    Base base = { .heights = NULL };
    rebuild(&bench, &base);
    for (int place = 0; place < (int)(sizeof places / sizeof *places); place++)
        for (int which = 0; which < BREAKS; which++) {
            char where[120];
            double x, y;
            if (!is_tried(place, which)) continue;
            snprintf(where, sizeof where, "%s, %s", places[place].name, break_name(which));
            restore_window(&bench);
            wr_tool_choose(app, 0);
            settle(&bench);
            if (!places[place].find(&bench, &x, &y)) {
                if (which == 0) complain(where, "no such place", "");
                continue;
            }
            broken_drag(&bench, x, y, 12, 30, which);
            push_key(app, SDLK_ESCAPE, KMOD_NONE); /* an opened menu */
            settle(&bench);
            see_state(&bench, where, &base, false);
            tries++;
        }
    printf("%d drags\n", tries);
    wr_field_free(base.heights);
    finish(&bench);
    assert_int_equal(complaints, 0);
}

/* ---- gestures with known results ---- */

/* A stroke of each mode is one step; undo and redo lead to the same heights. */
static void every_brush_mode_is_undone_and_redone(void **state)
{
    (void)state;
    Bench bench;
    Base base = { .heights = NULL };
    begin(&bench);
    complaints = 0;
    rebuild(&bench, &base);
    for (int mode = 0; mode < WR_BRUSH_MODE_COUNT; mode++) {
        double x, y;
        bench.app->settings->brush.mode = (WrBrushMode)mode;
        bench.app->settings->brush.radius = 6;
        wr_view_to_pixel(bench.app->view, 20, 20, &x, &y);
        drag(&bench, x, y, 40, 30);
        see_errors(&bench, wr_brush_modes[mode].name);
        assert_int_equal(wr_session_history_position(bench.session), base.position + 1);
        WrField *after = wr_field_share(wr_document_field(document_of(&bench)));
        wr_action_run(bench.app, "undo");
        settle(&bench);
        assert_true(is_base(&bench, &base));
        wr_action_run(bench.app, "redo");
        settle(&bench);
        const WrField *now = wr_document_field(document_of(&bench));
        for (int i = 0; i < 64 * 64; i++)
            assert_true(wr_field_get(now, i % 64, i / 64) == wr_field_get(after, i % 64, i / 64));
        wr_field_free(after);
        wr_action_run(bench.app, "undo");
        settle(&bench);
    }
    wr_field_free(base.heights);
    finish(&bench);
    assert_int_equal(complaints, 0);
}

/* In the column beside the cell, half a cell lower, the texel seen at row 40 is that of row 8. */
static void a_stroke_on_a_half_dropped_copy_changes_the_texel_shown_there(void **state)
{
    (void)state;
    Bench bench;
    double x, y;
    begin(&bench);
    WrApp *app = bench.app;
    wr_action_run(app, "tiling_half_drop");
    wr_action_run(app, "fit");
    settle(&bench);
    wr_view_zoom_at(app->view, app->view->x + app->view->w / 2.0, app->view->y + app->view->h / 2.0,
                    app->view->zoom / 3.0);
    settle(&bench);
    app->settings->brush = wr_brush_default();
    app->settings->brush.radius = 3;
    app->settings->brush.hardness = 1;
    wr_view_place(app->view, 64 + 16.5, 40.5, &x, &y);
    drag(&bench, x, y, 0, 0);
    const WrField *field = wr_document_field(document_of(&bench));
    assert_true(wr_field_get(field, 16, 8) > 0.0f);
    assert_true(wr_field_get(field, 16, 40) == 0.0f);
    wr_action_run(app, "tiling_straight"); /* settings are kept */
    finish(&bench);
}

static void one_of_two_lamps_is_dragged(void **state)
{
    (void)state;
    Bench bench;
    WrPointer lamp;
    begin(&bench);
    bench.app->settings->turning = false;
    run(&bench, "light directional to=-0.5,0.6,0.75 index=1");
    run(&bench, "light directional to=0.6,-0.5,0.75");
    settle(&bench);
    assert_int_equal(document_of(&bench)->scene->light_count, 2);
    WrLight was[2] = { document_of(&bench)->scene->lights[0],
                       document_of(&bench)->scene->lights[1] };
    assert_true(find_lamp(bench.app, &lamp));
    drag(&bench, lamp.x + 4, lamp.y + 4, 30, 20);
    int moved = 0;
    for (int i = 0; i < 2; i++)
        moved += document_of(&bench)->scene->lights[i].where.x != was[i].where.x;
    assert_int_equal(moved, 1);
    finish(&bench);
}

static void escape_gives_a_dragged_number_back(void **state)
{
    (void)state;
    Bench bench;
    double x, y;
    begin(&bench);
    WrApp *app = bench.app;
    run(&bench, "layer set 1 opacity=0.5");
    settle(&bench);
    const int before = wr_session_history_position(bench.session);
    assert_true(on_number(&bench, &x, &y));
    broken_drag(&bench, x, y, 30, 0, BREAK_KEYS);
    assert_int_equal(wr_session_history_position(bench.session), before);
    assert_true(document_of(&bench)->layers[0].opacity == 0.5f);
    assert_false(app->trying);
    /* undo is no part of a drag; 12 pixels beside the first press, so that the two are no double click */
    broken_drag(&bench, x + 12, y, 30, 0, BREAK_KEYS + 1);
    assert_int_equal(wr_session_history_position(bench.session), before + 1);
    assert_true(document_of(&bench)->layers[0].opacity != 0.5f);
    assert_int_equal(app->hand->grab, WR_GRAB_NONE);
    finish(&bench);
}

/* The key shows the reason as a note; nothing changes. */
static void delete_on_a_locked_layer_says_why(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    run(&bench, "layer add");
    run(&bench, "layer set 2 lock=on");
    settle(&bench);
    const int before = wr_session_history_position(bench.session);
    push_key(bench.app, SDLK_DELETE, KMOD_NONE);
    settle(&bench);
    const WrMessages *messages = bench.app->messages;
    assert_true(messages->list.count > 0);
    const WrMessage *last = &messages->list.data[messages->list.count - 1];
    assert_false(last->bad);
    assert_non_null(strstr(last->text, "is locked"));
    assert_int_equal(wr_session_history_position(bench.session), before);
    finish(&bench);
}

static void a_rectangle_selects_its_texels(void **state)
{
    (void)state;
    Bench bench;
    double x0, y0, x1, y1;
    begin(&bench);
    wr_action_run(bench.app, "select_rect");
    settle(&bench);
    wr_view_to_pixel(bench.app->view, 16, 24, &x0, &y0);
    wr_view_to_pixel(bench.app->view, 40, 40, &x1, &y1);
    drag(&bench, x0, y0, (int)lrint(x1 - x0), (int)lrint(y1 - y0));
    const WrField *selection = document_of(&bench)->selection;
    assert_non_null(selection);
    double count = 0;
    for (int i = 0; i < 64 * 64; i++) count += (double)wr_field_get(selection, i % 64, i / 64);
    assert_true(fabs(count - 24 * 16) <= 40); /* an edge is off by less than a texel */
    assert_true(wr_field_get(selection, 28, 32) == 1.0f);
    assert_true(wr_field_get(selection, 44, 32) == 0.0f);
    finish(&bench);
}

static void a_dragged_layer_changes_its_place(void **state)
{
    (void)state;
    Bench bench;
    double x, y;
    begin(&bench);
    run(&bench, "layer add upper");
    settle(&bench);
    assert_true(on_layer(&bench, &x, &y)); /* the upper one is the first row */
    drag(&bench, x + 60, y, 0, 70);
    assert_string_equal(wr_session_last_command(bench.session), "layer move 2 to=1");
    assert_string_equal(document_of(&bench)->layers[0].name, "upper");
    finish(&bench);
}

/* Opened by a key and walked by Tab: nothing had the focus before, so nothing has it afterwards, and the window must
   not wait for the frame that shows it. */
static void a_dialog_that_keys_walked_leaves_the_input_free(void **state)
{
    (void)state;
    static const char *const dialogs[] = { "help", "fill", "table_size", "search", "preferences" };
    Bench bench;
    double x, y;
    begin(&bench);
    wr_action_run(bench.app, "brush");
    settle(&bench);
    wr_view_to_pixel(bench.app->view, 32, 32, &x, &y);
    for (size_t k = 0; k < sizeof dialogs / sizeof *dialogs; k++) {
        wr_action_run(bench.app, dialogs[k]);
        settle(&bench);
        for (int i = 0; i < 5; i++) push_key(bench.app, SDLK_TAB, KMOD_NONE), settle(&bench);
        for (int i = 0; i < 3 && bench.app->dialog->now != WR_DIALOG_NONE; i++)
            push_key(bench.app, SDLK_ESCAPE, KMOD_NONE), settle(&bench);
        if (bench.app->dialog->now != WR_DIALOG_NONE) fail_msg("%s stays open", dialogs[k]);
        const double end = wr_clock_seconds() + PATIENCE; /* the veil behind a dialog fades */
        while (wr_gui_unsettled(bench.app->gui) && wr_clock_seconds() < end) draw_again(bench.app);
        if (wr_gui_unsettled(bench.app->gui)) fail_msg("%s leaves a frame to wait for", dialogs[k]);
        const int before = wr_session_history_position(bench.session);
        drag(&bench, x, y, 9, 4);
        if (wr_session_history_position(bench.session) != before + 1)
            fail_msg("no stroke after %s", dialogs[k]);
    }
    finish(&bench);
}

/* A model chosen in the search, or in any other place: the camera, which would be inside of it, moves back. */
static void a_chosen_surface_is_seen_whole(void **state)
{
    Bench bench;
    (void)state;
    begin(&bench);
    WrApp *app = bench.app;
    wr_search_index_update(app);
    wr_app_run_line(app, "camera perspective eye=0.1,0.05,0.3 fov=30 fit=off");
    settle(&bench);
    const WrSearchIndex *index = &app->finder->index;
    const WrSearchEntry *mug = NULL;
    for (int i = 0; i < index->entries.count; i++) {
        const WrSearchEntry *e = &index->entries.data[i];
        if (e->action && strcmp(e->action, "model mug") == 0) mug = e;
    }
    assert_non_null(mug);
    wr_search_index_open(app, mug);
    settle(&bench);
    const WrVec3 eye = wr_app_scene(app)->camera.eye;
    assert_non_null(wr_app_scene(app)->triangles);
    assert_true(sqrt(eye.x * eye.x + eye.y * eye.y + eye.z * eye.z) >
                2.0); /* the mug's radius is about 1 */
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_chosen_surface_is_seen_whole),
        cmocka_unit_test(dropped_pictures_are_asked_about_once),
        cmocka_unit_test(the_use_of_a_picture_is_guessed),
        cmocka_unit_test(a_dragged_frame_snaps_to_a_third_of_the_cell),
        cmocka_unit_test(a_dialog_that_keys_walked_leaves_the_input_free),
        cmocka_unit_test(a_lamp_is_dragged_while_the_patch_is_painted_on),
        cmocka_unit_test(a_transform_frame_is_that_of_the_content),
        cmocka_unit_test(several_chosen_layers_are_transformed_together),
        cmocka_unit_test(what_is_copied_comes_back_in_its_place),
        cmocka_unit_test(a_stroke_on_a_mask_hides_in_full),
        cmocka_unit_test(a_hovering_stamp_leaves_the_greys_alone),
        cmocka_unit_test(every_brush_mode_is_undone_and_redone),
        cmocka_unit_test(a_stroke_on_a_half_dropped_copy_changes_the_texel_shown_there),
        cmocka_unit_test(one_of_two_lamps_is_dragged),
        cmocka_unit_test(escape_gives_a_dragged_number_back),
        cmocka_unit_test(delete_on_a_locked_layer_says_why),
        cmocka_unit_test(a_rectangle_selects_its_texels),
        cmocka_unit_test(a_dragged_layer_changes_its_place),
        cmocka_unit_test(a_photo_is_seen_from_its_front),
        cmocka_unit_test(a_generators_preview_leaves_the_greys_as_they_were),
        /* last: they leave settings of their own */
        cmocka_unit_test(every_tool_survives_every_interruption),
        cmocka_unit_test(every_place_survives_every_interruption),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}
