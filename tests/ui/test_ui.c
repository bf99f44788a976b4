/* Geometry, keys, settings and filtered cells of the window: everything testable without a window. */
#include "test.h"

#include "base/error.h"
#include "base/text.h"
#include "base/vec.h"

#include "ui/canvas/canvas_mips.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/line.h"
#include "ui/patch/preview/rotation.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/view.h"

/* ---- view ---- */

static WrCanvasView some_view(void)
{
    return (WrCanvasView){ .x = 48,
                           .y = 73,
                           .w = 545,
                           .h = 799,
                           .table_w = 512,
                           .table_h = 256,
                           .zoom = 0.7,
                           .centre_x = 100,
                           .centre_y = 200 };
}

static void pixels_and_texels_are_each_others_inverse(void **state)
{
    (void)state;
    TestRandom r = { 1 };
    WrCanvasView view = some_view();
    for (int i = 0; i < 200; i++) {
        double px = 2000 * test_random(&r) - 500, py = 2000 * test_random(&r) - 500, x, y, qx, qy;
        view.zoom = exp2(12 * test_random(&r) - 6);
        wr_view_to_texel(&view, px, py, &x, &y);
        wr_view_to_pixel(&view, x, y, &qx, &qy);
        assert_near(qx, px, 1e-9 * 2000);
        assert_near(qy, py, 1e-9 * 2000);
    }
}

static void the_middle_of_the_canvas_shows_the_centre_texel(void **state)
{
    (void)state;
    WrCanvasView view = some_view();
    double u, v;
    wr_view_to_uv(&view, 48 + 545 / 2.0, 73 + 799 / 2.0, &u, &v);
    assert_near(u, 100.0 / 512.0, 1e-15);
    assert_near(v, 1.0 - 200.0 / 256.0, 1e-15); /* rows run down, v up */
}

static void zooming_keeps_the_texel_under_the_pointer(void **state)
{
    (void)state;
    TestRandom r = { 2 };
    for (int i = 0; i < 100; i++) {
        WrCanvasView view = some_view();
        double px = 48 + 545 * test_random(&r), py = 73 + 799 * test_random(&r), x0, y0, x1, y1;
        wr_view_to_texel(&view, px, py, &x0, &y0);
        wr_view_zoom_at(&view, px, py, exp2(10 * test_random(&r) - 5));
        wr_view_to_texel(&view, px, py, &x1, &y1);
        /* the same texel, possibly of another copy */
        assert_near((x1 - x0) / 512 - rint((x1 - x0) / 512), 0, 1e-9);
        assert_near((y1 - y0) / 256 - rint((y1 - y0) / 256), 0, 1e-9);
    }
}

static void panning_moves_the_picture_by_the_pixels_dragged(void **state)
{
    (void)state;
    WrCanvasView view = some_view();
    double x0, y0, x1, y1;
    wr_view_to_texel(&view, 300, 300, &x0, &y0);
    wr_view_pan(&view, 30, -20);
    wr_view_to_texel(&view, 330, 280, &x1, &y1);
    assert_near(x1, x0, 1e-9);
    assert_near(y1, y0, 1e-9);
    for (int i = 0; i < 10000; i++) wr_view_pan(&view, 999, 777); /* positions never grow */
    assert_true(view.centre_x >= 0 && view.centre_x < 512);
    assert_true(view.centre_y >= 0 && view.centre_y < 256);
}

/* Mirrored at the canvas's centre: a point at the left appears at the right. */
static void a_mirrored_view_shows_left_at_the_right(void **state)
{
    (void)state;
    TestRandom r = { 3 };
    const double middle = 48 + 545 / 2.0;
    for (int i = 0; i < 50; i++) {
        WrCanvasView view = some_view(), mirrored = view;
        double px = 48 + 545 * test_random(&r), py = 73 + 799 * test_random(&r), x, y, qx, qy;
        mirrored.mirrored = true;
        wr_view_to_texel(&view, px, py, &x, &y);
        wr_view_to_pixel(&mirrored, x, y, &qx, &qy);
        assert_near(qx, 2 * middle - px, 1e-9);
        assert_near(qy, py, 1e-9);
        wr_view_pan(&mirrored, 31, -7); /* under the pointer it still moves with the drag */
        wr_view_to_texel(&mirrored, qx + 31, qy - 7, &px, &py);
        assert_near((px - x) / 512 - rint((px - x) / 512), 0, 1e-9);
        assert_near((py - y) / 256 - rint((py - y) / 256), 0, 1e-9);
    }
}

static void zoom_stops_at_its_limits_for_tables_of_any_size(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 1, 1 }, { 1, 16384 }, { 16384, 16384 }, { 37, 5 } };
    for (int i = 0; i < 4; i++) {
        WrCanvasView view = some_view();
        view.table_w = sizes[i][0];
        view.table_h = sizes[i][1];
        wr_view_fit(&view, 0.1);
        assert_true(view.zoom > 0 && isfinite(view.zoom));
        wr_view_zoom_at(&view, 100, 100, 1e300);
        assert_near(view.zoom, 128, 0);
        wr_view_zoom_at(&view, 100, 100, 0);
        assert_true(view.zoom >= 1.0 / 128.0);
        assert_true(isfinite(view.centre_x) && isfinite(view.centre_y));
    }
}

/* ---- the brush's outline ---- */

static void an_outline_in_the_middle_of_the_cell_has_no_copies(void **state)
{
    (void)state;
    WrCanvasView view = some_view();
    WrShift copies[WR_VIEW_COPIES];
    assert_int_equal(wr_view_outline_copies(&view, true, true, 256, 128, 100, copies), 1);
    assert_near(copies[0].dx, 0, 0);
    assert_near(copies[0].dy, 0, 0);
}

/* Near the right edge the stroke enters at the left; in a corner, at three other corners. */
static void hc73_an_outline_over_an_edge_shows_on_the_other_side(void **state)
{
    (void)state;
    WrCanvasView view = some_view();
    WrShift copies[WR_VIEW_COPIES];
    assert_int_equal(wr_view_outline_copies(&view, true, true, 505, 128, 20, copies), 2);
    assert_near(copies[1].dx, -512, 0);
    assert_near(copies[1].dy, 0, 0);
    assert_int_equal(wr_view_outline_copies(&view, true, true, 505, 250, 20, copies), 4);
    assert_int_equal(wr_view_outline_copies(&view, false, true, 505, 250, 20, copies), 2);
    assert_int_equal(wr_view_outline_copies(&view, false, false, 505, 250, 20, copies), 1);
    /* the diagonal copy only if the disc itself reaches the corner */
    assert_int_equal(wr_view_outline_copies(&view, true, true, 512 - 15, 256 - 15, 20, copies), 3);
}

static void an_outline_on_a_copy_is_brought_home(void **state)
{
    (void)state;
    WrCanvasView view = some_view();
    WrShift copies[WR_VIEW_COPIES];
    int count = wr_view_outline_copies(&view, true, true, 256 - 3 * 512, 128 + 7 * 256, 10, copies);
    assert_int_equal(count, 1);
    assert_near(copies[0].dx, 3 * 512, 0);
    assert_near(copies[0].dy, -7 * 256, 0);
}

/* x rotates y to z, y rotates z to x, z rotates x to y; x comes first. */

static void assert_same_rotation(const WrRotation *a, const WrRotation *b, double tolerance)
{
    for (int i = 0; i < 9; i++) assert_near(a->m[i], b->m[i], tolerance);
}

/* x turns y to z, y turns z to x, z turns x to y; x comes first. */
static void rotations_turn_the_right_way_and_in_the_right_order(void **state)
{
    (void)state;
    WrRotation r = wr_rotation_from_deg((WrVec3){ 90, 0, 0 });
    WrVec3 v = wr_rotation_apply(&r, (WrVec3){ 0, 1, 0 });
    assert_near(v.z, 1, 1e-15);
    r = wr_rotation_from_deg((WrVec3){ 90, 90, 0 }); /* y -> z -> x */
    v = wr_rotation_apply(&r, (WrVec3){ 0, 1, 0 });
    assert_near(v.x, 1, 1e-15);
    r = wr_rotation_from_deg((WrVec3){ 90, 90, 90 }); /* ... -> y */
    v = wr_rotation_apply(&r, (WrVec3){ 0, 1, 0 });
    assert_near(v.y, 1, 1e-15);
}

static void angles_of_any_rotation_give_that_rotation_again(void **state)
{
    (void)state;
    TestRandom r = { 3 };
    for (int i = 0; i < 500; i++) {
        WrVec3 deg = { 720 * test_random(&r) - 360, 720 * test_random(&r) - 360,
                       720 * test_random(&r) - 360 };
        WrRotation a = wr_rotation_from_deg(deg);
        WrRotation b = wr_rotation_from_deg(wr_rotation_to_deg(&a));
        assert_same_rotation(&a, &b, 1e-12);
    }
}

/* At y = +-90 degrees, x and z rotate about the same axis. */
static void gimbal_lock_still_gives_the_rotation_again(void **state)
{
    (void)state;
    for (int y = -90; y <= 90; y += 180) {
        for (int x = -180; x <= 180; x += 30) {
            WrRotation a = wr_rotation_from_deg((WrVec3){ x, y, 50 });
            WrVec3 deg = wr_rotation_to_deg(&a);
            WrRotation b = wr_rotation_from_deg(deg);
            assert_same_rotation(&a, &b, 1e-8);
            assert_near(deg.z, 0, 0);
        }
    }
}

static void a_drag_to_the_right_moves_the_front_to_the_right(void **state)
{
    (void)state;
    const WrVec3 right = { 1, 0, 0 }, up = { 0, 1, 0 };
    for (int turn = 0; turn < 360; turn += 45) {
        WrRotation own = wr_rotation_from_deg((WrVec3){ -90, 20, 5 });
        WrRotation table = wr_rotation_axis((WrVec3){ 0, 1, 0 }, turn);
        WrRotation before = wr_rotation_times(&table, &own);
        WrRotation now = wr_rotation_dragged(&own, turn, right, up, 100, 0, 1000);
        WrRotation after = wr_rotation_times(&table, &now);
        /* the object point in front has moved by 18 degrees to the right, for any rotation */
        WrRotation back = wr_rotation_from_deg((WrVec3){ 0, 0, 0 });
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) back.m[3 * i + j] = before.m[3 * j + i];
        WrVec3 point = wr_rotation_apply(&back, (WrVec3){ 0, 0, 1 });
        WrVec3 moved = wr_rotation_apply(&after, point);
        assert_near(moved.x, sin(18 * 3.14159265358979 / 180), 1e-12);
        assert_near(moved.y, 0, 1e-12);
    }
}

static void a_drag_down_moves_the_front_down_and_no_drag_changes_nothing(void **state)
{
    (void)state;
    WrRotation own = wr_rotation_from_deg((WrVec3){ 0, 0, 0 });
    WrRotation now =
        wr_rotation_dragged(&own, 0, (WrVec3){ 1, 0, 0 }, (WrVec3){ 0, 1, 0 }, 0, 100, 1000);
    WrVec3 front = wr_rotation_apply(&now, (WrVec3){ 0, 0, 1 });
    assert_true(front.y < -0.3);
    now = wr_rotation_dragged(&own, 77, (WrVec3){ 1, 0, 0 }, (WrVec3){ 0, 1, 0 }, 0, 0, 1000);
    assert_same_rotation(&now, &own, 1e-14);
}

/* ---- pad of the light ---- */

static void places_of_lights_are_taken_back_to_their_directions(void **state)
{
    (void)state;
    TestRandom r = { 4 };
    for (int i = 0; i < 500; i++) {
        double x = 2 * test_random(&r) - 1, y = 2 * test_random(&r) - 1, bx, by;
        WrVec3 d = wr_light_from_pad(x, y);
        assert_near(v3_len(d), 1, 1e-12);
        wr_light_to_pad(v3_scale(d, 1e3 * test_random(&r) + 1e-3), &bx, &by);
        assert_near(bx, x, 1e-7);
        assert_near(by, y, 1e-7);
    }
}

static void a_light_from_the_upper_left_stands_at_the_upper_left(void **state)
{
    (void)state;
    double x, y;
    wr_light_to_pad((WrVec3){ -1, 1, 1 }, &x, &y);
    assert_true(x < -0.6 && y > 0.6);
    assert_near(x, -y, 1e-12);
    wr_light_to_pad((WrVec3){ 0, 0, 1 }, &x, &y);
    assert_near(x, 0, 0);
    assert_near(y, 0, 0);
    wr_light_to_pad((WrVec3){ 0, 0, -1 }, &x, &y); /* straight from behind: undefined, but finite */
    assert_true(isfinite(x) && isfinite(y));
    wr_light_to_pad((WrVec3){ 0.3, 0, -1 }, &x, &y); /* from behind: the rim */
    assert_near(x, 1, 1e-12);
    assert_near(wr_light_from_pad(5, 0).z, cos(100 * 3.14159265358979 / 180), 1e-12);
}

/* ---- layout ---- */

static bool overlap(const SDL_Rect *a, const SDL_Rect *b)
{
    return a->w > 0 && b->w > 0 && a->x < b->x + b->w && b->x < a->x + a->w && a->y < b->y + b->h &&
           b->y < a->y + a->h;
}

static void check_layout(const WrLayoutInput *in)
{
    WrLayout l = wr_layout_make(in);
    const SDL_Rect *r[] = { &l.options, &l.strip,  &l.canvas,        &l.divider, &l.patch,
                            &l.panel,   &l.status, &l.panel_divider, &l.lower,   &l.side };
    long area = 0;
    for (int i = 0; i < 10; i++) {
        area += (long)r[i]->w * r[i]->h;
        assert_true(r[i]->x >= 0 && r[i]->y >= 0 && r[i]->w >= 0 && r[i]->h >= 0);
        assert_true(r[i]->x + r[i]->w <= in->width && r[i]->y + r[i]->h <= in->height);
        for (int j = 0; j < i; j++) assert_false(overlap(r[i], r[j]));
    }
    /* no gaps: the areas add up to the window below the menu */
    assert_int_equal(area, (long)in->width * (in->height - in->menu_height));
    if (!in->panels) return;
    assert_true(l.panel.w <= in->width / 2);
    assert_int_equal(l.panel.w == 0, in->side_width < 0);
    /* something to drag remains at each closed area */
    assert_true(l.side.w >= 4 * in->scale);
    if (in->views == WR_VIEWS_BOTH)
        assert_true((l.stacked ? l.divider.h : l.divider.w) >= 4 * in->scale);
}

static WrLayoutInput layout_of(int width, int height)
{
    return (WrLayoutInput){ .width = width,
                            .height = height,
                            .menu_height = 29,
                            .scale = 1,
                            .divider = 0.5,
                            .panels = true,
                            .lower = 0.4,
                            .tools = 17 };
}

static double random_part(void)
{
    static uint32_t seed = 20261130;
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) / 16777216.0;
}

/* A third of the values are the ends, which close something. */
static double random_share(void)
{
    const double x = random_part();
    return x < 1 / 6.0 ? 0.0 : x > 5 / 6.0 ? 1.0 : random_part();
}

static void parts_of_the_window_cover_it_without_overlap(void **state)
{
    (void)state;
    for (int i = 0; i < 20000; i++) {
        const double scale = 0.75 + 2.25 * random_part();
        WrLayoutInput in = layout_of((int)((640 + 3300 * random_part()) * fmin(scale, 1.2)),
                                     (int)((420 + 1800 * random_part()) * fmin(scale, 1.2)));
        in.scale = scale;
        if (in.width < 560 * scale || in.height < 360 * scale) continue;
        in.menu_height = (int)(29 * scale);
        in.divider = random_share();
        in.lower = fmin(random_share(), 0.95);
        in.views = (WrShownViews)(i % 3);
        in.panels = i % 7 != 0;
        in.side_width = i % 5 == 0 ? -1 : i % 5 == 1 ? 0 : 2000 * random_part() + 1;
        in.side_left = random_part() < 0.5;
        in.hide_strip = random_part() < 0.3;
        in.hide_options = random_part() < 0.3;
        check_layout(&in);
    }
}

static void a_view_is_usable_or_closed_wherever_the_divider_is_dragged(void **state)
{
    (void)state;
    WrLayoutInput in = layout_of(900, 600);
    bool closed[2] = { false };
    for (int x = -100; x < 1000; x += 7) {
        WrLayout l = wr_layout_make(&in);
        in.divider = wr_layout_divider_at(&l, x, 300);
        l = wr_layout_make(&in);
        assert_true((l.canvas.w >= 120 || l.canvas.w == 0) && (l.patch.w >= 120 || l.patch.w == 0));
        closed[0] |= l.canvas.w == 0, closed[1] |= l.patch.w == 0;
        if (x > 210 && x < 520) assert_near(l.divider.x + l.divider.w / 2.0, x, 2);
    }
    assert_true(closed[0] && closed[1]);
}

static void the_side_panel_follows_its_divider_on_both_sides(void **state)
{
    (void)state;
    for (int left = 0; left < 2; left++) {
        WrLayoutInput in = layout_of(1440, 900);
        in.side_left = left;
        for (int wide = 0; wide < 1000; wide += 13) {
            WrLayout l = wr_layout_make(&in);
            in.side_width = wr_layout_side_at(&l, in.width, 1, left ? wide : in.width - wide);
            l = wr_layout_make(&in);
            assert_int_equal(l.panel.w == 0, wide < 108);
            if (wide > 220 && wide < 720) assert_near(l.panel.w, wide, 4);
            if (wide > 740) assert_int_equal(l.panel.w, 720);
            assert_int_equal(l.panel.w == 0 || (l.panel.x == 0) == left, true);
            assert_int_equal(l.strip.x == 0, !left);
        }
    }
}

static void views_are_stacked_in_a_tall_window(void **state)
{
    (void)state;
    WrLayoutInput in = layout_of(800, 1200);
    WrLayout l = wr_layout_make(&in);
    assert_true(l.stacked);
    assert_true(l.patch.y > l.canvas.y);
    assert_int_equal(l.patch.x, l.canvas.x);
    in.width = 1300;
    assert_false(wr_layout_make(&in).stacked);
}

/* ---- keys ---- */

static SDL_Keysym keysym(SDL_Keycode code, int mod)
{
    return (SDL_Keysym){ .sym = code, .mod = (Uint16)mod };
}

static void keys_find_their_actions(void **state)
{
    (void)state;
    WrKeyMap *map = wr_keys_new();
    assert_string_equal(wr_keys_find(map, keysym(SDLK_s, KMOD_LCTRL)), "save");
    assert_string_equal(wr_keys_find(map, keysym(SDLK_s, KMOD_RCTRL | KMOD_LSHIFT)), "save_as");
    assert_null(wr_keys_find(map, keysym(SDLK_s, KMOD_LCTRL | KMOD_LALT)));
    /* locks are ignored */
    assert_string_equal(wr_keys_find(map, keysym(SDLK_b, KMOD_NUM)), "brush");
    assert_string_equal(wr_keys_find(map, keysym(SDLK_z, KMOD_CTRL)), "undo");
    assert_string_equal(wr_keys_find(map, keysym(SDLK_y, KMOD_CTRL)), "redo");
    assert_string_equal(wr_keys_find(map, keysym(SDLK_PLUS, 0)), "zoom_in");
    assert_string_equal(wr_keys_find(map, keysym(SDLK_KP_PLUS, 0)), "zoom_in");
    assert_string_equal(wr_keys_find(map, keysym(SDLK_TAB, 0)), "panels");
    wr_keys_free(map);
}

/* A German keyboard has u-umlaut where a US one has [. */
static void brackets_count_by_place_where_a_layout_has_none(void **state)
{
    (void)state;
    WrKeyMap *map = wr_keys_new();
    SDL_Keysym umlaut = { .scancode = SDL_SCANCODE_LEFTBRACKET, .sym = 0xfc, .mod = 0 };
    assert_string_equal(wr_keys_find(map, umlaut), "size_down");
    umlaut.mod = KMOD_LSHIFT;
    assert_string_equal(wr_keys_find(map, umlaut), "hardness_down");
    wr_keys_free(map);
}

static void a_users_line_replaces_the_keys_of_its_action(void **state)
{
    (void)state;
    WrError err;
    WrKeyMap *map = wr_keys_new();
    char label[32];
    assert_true(wr_keys_read(map, "# mine\n\nundo: F5 Alt+Left # both\r\nsave:\n", &err));
    assert_string_equal(wr_keys_find(map, keysym(SDLK_F5, 0)), "undo");
    assert_string_equal(wr_keys_find(map, keysym(SDLK_LEFT, KMOD_LALT)), "undo");
    assert_null(wr_keys_find(map, keysym(SDLK_z, KMOD_CTRL)));
    assert_null(wr_keys_find(map, keysym(SDLK_s, KMOD_CTRL)));
    assert_string_equal(wr_keys_label(map, "undo", label), "F5");
    assert_string_equal(wr_keys_label(map, "save", label), "");
    wr_keys_free(map);
}

static void broken_key_files_say_where_and_change_nothing(void **state)
{
    (void)state;
    static const char *const broken[] = {
        "undo: F5\nredo: Nokey\n", "undo F5\n", ": F5\n", "undo: Ctrl+\n",
        "undo: Ctrl+Ctrl+averyveryverylongnameofakeythatisnone\n"
    };
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        WrError err = { "" };
        WrKeyMap *map = wr_keys_new();
        assert_false(wr_keys_read(map, broken[i], &err));
        assert_non_null(strstr(err.text, i == 0 ? "line 2" : "line 1"));
        assert_string_equal(wr_keys_find(map, keysym(SDLK_z, KMOD_CTRL)), "undo");
        wr_keys_free(map);
    }
}

/* ---- settings ---- */

static void settings_survive_being_written_and_read(void **state)
{
    (void)state;
    WrSettings a = wr_settings_default(), b = wr_settings_default();
    a.width = 1234;
    a.divider = 0.3;
    a.scale = 1.5;
    a.turning = false;
    a.brush.radius = 77.5;
    a.brush.hardness = 0.25;
    a.brush.strength = -0.125;
    a.brush.mode = WR_BRUSH_TO;
    a.brush.to = 0.1;
    a.brush.opacity = 0.75;
    a.symmetry.radial = 5;
    a.drawing.tolerance = 0.125;
    a.look = (WrCanvasDisplay){
        WR_CANVAS_CAVITY, WR_CANVAS_SIGNED, { true, false }, true, -2, 3, 0.3, -0.4
    };
    wr_settings_add_recent(&a, "/one");
    wr_settings_add_recent(&a, "/with a space/two");
    WrText text = { 0 }, again = { 0 };
    wr_settings_print(&a, &text);
    wr_settings_parse(&b, wr_text_get(&text));
    wr_settings_print(&b, &again);
    assert_string_equal(wr_text_get(&text), wr_text_get(&again));
    assert_int_equal(b.width, 1234);
    assert_near(b.brush.radius, 77.5, 0);
    assert_int_equal(b.brush.mode, WR_BRUSH_TO);
    assert_string_equal(b.recent[0], "/with a space/two");
    assert_string_equal(b.recent[1], "/one");
    wr_text_fini(&text);
    wr_text_fini(&again);
    wr_settings_fini(&a);
    wr_settings_fini(&b);
}

static void damaged_settings_leave_the_defaults(void **state)
{
    (void)state;
    WrSettings s = wr_settings_default();
    wr_settings_parse(
        &s, "width -5\nheight 1e9\ndivider nan\nmode 99\nbrush\n\n \nscale\nlow 5\nhigh 4\n"
            "radius 12x\nmystery 3\nrecent \nturning");
    assert_int_equal(s.width, 1440);
    assert_int_equal(s.height, 900);
    assert_near(s.divider, 0.5, 0);
    assert_int_equal(s.brush.mode, WR_BRUSH_RAISE);
    assert_near(s.brush.radius, 16, 0);
    assert_true(s.look.low < s.look.high);
    assert_null(s.recent[0]);
    wr_settings_fini(&s);
}

static void recent_files_are_few_and_without_doubles(void **state)
{
    (void)state;
    WrSettings s = wr_settings_default();
    char path[16];
    for (int i = 0; i < 20; i++) {
        snprintf(path, sizeof path, "/%d", i);
        wr_settings_add_recent(&s, path);
    }
    wr_settings_add_recent(&s, "/17");
    assert_string_equal(s.recent[0], "/17");
    assert_string_equal(s.recent[1], "/19");
    assert_string_equal(s.recent[2], "/18");
    assert_string_equal(s.recent[3], "/16");
    assert_string_equal(s.recent[WR_RECENT_MAX - 1], "/12");
    wr_settings_fini(&s);
}

/* ---- cells and taps ---- */

/* The mean over a pixel's footprint, by definition. */
static double mean_over(const double *texels, int size, double from, double to)
{
    double sum = 0;
    for (int i = (int)floor(from); i < to; i++) {
        double low = fmax(from, i), high = fmin(to, i + 1);
        sum += (high - low) * texels[((i % size) + size) % size];
    }
    return sum / (to - from);
}

static void pixels_weigh_texels_by_what_they_cover(void **state)
{
    (void)state;
    TestRandom r = { 5 };
    double texels[23];
    for (int i = 0; i < 23; i++) texels[i] = test_random(&r);
    for (int k = 0; k < 1000; k++) {
        double from = 200 * test_random(&r) - 100, to = from + 0.01 + 1.98 * test_random(&r);
        WrCellTaps taps = wr_taps_make(from, to, 23, 0, true);
        double sum = 0, weight = 0;
        for (int i = 0; i < WR_TAPS; i++) {
            assert_true(taps.cell[i] >= 0 && taps.cell[i] < 23);
            sum += (double)taps.weight[i] * texels[taps.cell[i]];
            weight += (double)taps.weight[i];
        }
        assert_near(weight, 1, 1e-6);
        assert_near(sum, mean_over(texels, 23, from, to), 1e-6); /* single precision */
    }
}

/* Cells of 4 over 23 texels: the last one holds 3. */
static void coarse_cells_at_the_seam_keep_their_true_width(void **state)
{
    (void)state;
    TestRandom r = { 6 };
    double texels[23], cells[6];
    for (int c = 0; c < 6; c++) {
        cells[c] = test_random(&r);
        for (int i = 4 * c; i < 4 * c + 4 && i < 23; i++) texels[i] = cells[c];
    }
    for (int k = 0; k < 1000; k++) {
        double from = 100 * test_random(&r) - 50, to = from + 4 + 4 * test_random(&r), sum = 0;
        WrCellTaps taps = wr_taps_make(from, to, 23, 2, true);
        for (int i = 0; i < WR_TAPS; i++) sum += (double)taps.weight[i] * cells[taps.cell[i]];
        assert_near(sum, mean_over(texels, 23, from, to), 1e-6);
    }
}

static void beyond_the_edge_of_a_clamped_axis_there_is_nothing(void **state)
{
    (void)state;
    assert_true(wr_taps_make(-2, -1, 16, 0, false).outside);
    assert_true(wr_taps_make(16.2, 17, 16, 0, false).outside);
    assert_false(wr_taps_make(15.2, 15.9, 16, 0, false).outside);
    WrCellTaps edge = wr_taps_make(-0.4, 0.6, 16, 0, false);
    assert_false(edge.outside);
    assert_int_equal(edge.cell[0], 0);
    assert_near((double)edge.weight[0], 1, 1e-6);
}

static void levels_keep_a_cell_between_half_a_pixel_and_one(void **state)
{
    (void)state;
    for (double zoom = 128; zoom > 1.0 / 64; zoom /= 1.1) {
        int level = wr_canvas_mips_level(zoom);
        double pixels = zoom * (1 << level);
        if (zoom > 0.5) assert_int_equal(level, 0);
        else assert_true(pixels > 0.5 && pixels <= 1.0);
    }
}

static void count_tile(int tx, int ty, void *ctx)
{
    (void)tx;
    (void)ty;
    ++*(int *)ctx;
}

/* 100 x 70 texels: tiles at the right and lower edge are cut off; means include only texels inside. */
static void means_of_cut_off_tiles_count_only_what_is_inside(void **state)
{
    (void)state;
    WrField *field = wr_field_new(100, 70, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < 70; j++)
        for (int i = 0; i < 100; i++) wr_field_set(field, i, j, (float)(i + 1000 * j));
    WrCanvasMips *cells = wr_canvas_mips_new();
    int changes = 0;
    float flat;
    assert_false(wr_canvas_mips_update(cells, field, 3, count_tile, &changes));
    const float *mean = wr_canvas_mips_block(cells, 1, 1, 1e300, &flat);
    /* cell (12, 8): columns 96..99, rows 64..69 */
    assert_near((double)mean[0 * 8 + 4], 97.5 + 1000 * 66.5, 1e-2);
    mean = wr_canvas_mips_block(cells, 0, 0, 1e300, &flat);
    assert_near((double)mean[9], 11.5 + 1000 * 11.5, 1e-2);
    assert_false(wr_canvas_mips_rough(cells));
    float low, high;
    wr_canvas_mips_range(cells, NULL, &low, &high);
    assert_near((double)low, 0, 0);
    assert_near((double)high, 69099, 0);
    wr_canvas_mips_free(cells);
    wr_field_free(field);
}

static void an_edit_is_seen_and_costs_its_tile_alone(void **state)
{
    (void)state;
    WrField *field = wr_field_new(512, 512, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.25f, NULL);
    WrCanvasMips *cells = wr_canvas_mips_new();
    int changes = 0;
    float flat = 0, low, high;
    wr_canvas_mips_update(cells, field, 2, count_tile, &changes);
    assert_null(wr_canvas_mips_block(cells, 3, 5, 1e300, &flat));
    assert_near((double)flat, 0.25, 0);
    wr_canvas_mips_range(cells, NULL, &low, &high);
    wr_field_set(field, 3 * 64 + 7, 5 * 64 + 9, 16.25f);
    assert_true(wr_canvas_mips_update(cells, field, 2, count_tile, &changes));
    assert_int_equal(changes, 1);
    const float *mean = wr_canvas_mips_block(cells, 3, 5, 1e300, &flat);
    assert_near((double)mean[16 * 2 + 1], 1.25, 1e-6); /* one of 16 texels is 16 higher */
    assert_near((double)mean[0], 0.25, 0);
    wr_canvas_mips_range(cells, NULL, &low, &high);
    assert_near((double)high, 16.25, 0);
    assert_true(wr_canvas_mips_update(cells, field, 2, count_tile, &changes));
    assert_int_equal(changes, 1); /* nothing changed since */
    wr_canvas_mips_free(cells);
    wr_field_free(field);
}

/* After any edit or undo, the range is that of the whole table. */
static void the_range_follows_every_edit(void **state)
{
    (void)state;
    TestRandom r = { 571 };
    WrField *field = wr_field_new(211, 157, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.125f, NULL);
    WrCanvasMips *cells = wr_canvas_mips_new();
    int changes = 0, places[6][2];
    for (int i = 0; i < 200; i++) {
        int *place = places[i % 6];
        if (i >= 6 && i % 3 == 0) wr_field_set(field, place[0], place[1], 0.125f);
        place[0] = (int)(211 * test_random(&r));
        place[1] = (int)(157 * test_random(&r));
        wr_field_set(field, place[0], place[1], (float)(3 * test_random(&r) - 1.4));
        wr_canvas_mips_update(cells, field, 1, count_tile, &changes);
        float low, high, least, most;
        wr_canvas_mips_range(cells, NULL, &low, &high);
        wr_field_range(field, &least, &most);
        assert_true(low == least && high == most);
    }
    wr_canvas_mips_free(cells);
    wr_field_free(field);
}

/* With no time left, single texels replace means, and the cache reports it until they are computed. */
static void late_means_are_rough_and_made_good_later(void **state)
{
    (void)state;
    WrField *field = wr_field_new(64, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) wr_field_set(field, i, j, (float)i);
    WrCanvasMips *cells = wr_canvas_mips_new();
    float flat;
    wr_canvas_mips_update(cells, field, 6, count_tile, NULL);
    assert_near((double)wr_canvas_mips_block(cells, 0, 0, 0, &flat)[0], 0, 0);
    assert_true(wr_canvas_mips_rough(cells));
    wr_canvas_mips_forget_rough(cells);
    assert_near((double)wr_canvas_mips_block(cells, 0, 0, 1e300, &flat)[0], 31.5, 1e-5);
    assert_false(wr_canvas_mips_rough(cells));
    wr_canvas_mips_free(cells);
    wr_field_free(field);
}

/* ---- lines ---- */

static void lines_hold_numbers_as_a_hand_places_them(void **state)
{
    (void)state;
    WrText line = { 0 };
    wr_text_add(&line, "light directional");
    wr_line_vec(&line, "to", wr_line_round_vec((WrVec3){ -0.49999, 1.0 / 3, -0.00001 }, 3));
    wr_line_number(&line, "strength", wr_line_round(0.1 + 0.2, 9));
    assert_string_equal(wr_text_get(&line), "light directional to=-0.5,0.333,0 strength=0.3");
    wr_text_fini(&line);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_and_texels_are_each_others_inverse),
        cmocka_unit_test(the_middle_of_the_canvas_shows_the_centre_texel),
        cmocka_unit_test(zooming_keeps_the_texel_under_the_pointer),
        cmocka_unit_test(panning_moves_the_picture_by_the_pixels_dragged),
        cmocka_unit_test(a_mirrored_view_shows_left_at_the_right),
        cmocka_unit_test(zoom_stops_at_its_limits_for_tables_of_any_size),
        cmocka_unit_test(an_outline_in_the_middle_of_the_cell_has_no_copies),
        cmocka_unit_test(hc73_an_outline_over_an_edge_shows_on_the_other_side),
        cmocka_unit_test(an_outline_on_a_copy_is_brought_home),
        cmocka_unit_test(rotations_turn_the_right_way_and_in_the_right_order),
        cmocka_unit_test(angles_of_any_rotation_give_that_rotation_again),
        cmocka_unit_test(gimbal_lock_still_gives_the_rotation_again),
        cmocka_unit_test(a_drag_to_the_right_moves_the_front_to_the_right),
        cmocka_unit_test(a_drag_down_moves_the_front_down_and_no_drag_changes_nothing),
        cmocka_unit_test(places_of_lights_are_taken_back_to_their_directions),
        cmocka_unit_test(a_light_from_the_upper_left_stands_at_the_upper_left),
        cmocka_unit_test(parts_of_the_window_cover_it_without_overlap),
        cmocka_unit_test(a_view_is_usable_or_closed_wherever_the_divider_is_dragged),
        cmocka_unit_test(the_side_panel_follows_its_divider_on_both_sides),
        cmocka_unit_test(views_are_stacked_in_a_tall_window),
        cmocka_unit_test(keys_find_their_actions),
        cmocka_unit_test(brackets_count_by_place_where_a_layout_has_none),
        cmocka_unit_test(a_users_line_replaces_the_keys_of_its_action),
        cmocka_unit_test(broken_key_files_say_where_and_change_nothing),
        cmocka_unit_test(settings_survive_being_written_and_read),
        cmocka_unit_test(damaged_settings_leave_the_defaults),
        cmocka_unit_test(recent_files_are_few_and_without_doubles),
        cmocka_unit_test(pixels_weigh_texels_by_what_they_cover),
        cmocka_unit_test(coarse_cells_at_the_seam_keep_their_true_width),
        cmocka_unit_test(beyond_the_edge_of_a_clamped_axis_there_is_nothing),
        cmocka_unit_test(levels_keep_a_cell_between_half_a_pixel_and_one),
        cmocka_unit_test(means_of_cut_off_tiles_count_only_what_is_inside),
        cmocka_unit_test(an_edit_is_seen_and_costs_its_tile_alone),
        cmocka_unit_test(the_range_follows_every_edit),
        cmocka_unit_test(late_means_are_rough_and_made_good_later),
        cmocka_unit_test(lines_hold_numbers_as_a_hand_places_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
