/* The table on the canvas: rotated, mirrored, with shifted copies; drawn as the geometry requires. */
#include "test.h"

#include "field/field.h"

#include "ui/canvas/marching_ants.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/canvas_colors.h"
#include "ui/canvas/view.h"
#include "ui/toolkit/retained_frame.h"

#include <SDL.h>

#define WIDE 211
#define TALL 149

static WrCanvasView random_view(TestRandom *r, int w, int h)
{
    WrCanvasView view = { .x = 0, .y = 0, .w = WIDE, .h = TALL, .table_w = w, .table_h = h };
    view.zoom = exp2(6 * test_random(r) - 1);
    view.centre_x = w * test_random(r);
    view.centre_y = h * test_random(r);
    view.mirrored = test_random(r) < 0.5;
    view.turn = 360 * test_random(r) - 180;
    view.tiling = (WrTiling)(3 * test_random(r));
    return view;
}

/* By hand: a view rotated by a quarter clockwise shows the right side at the bottom. */
static void a_quarter_turn_puts_right_below(void **state)
{
    (void)state;
    WrCanvasView view = { .x = 17, .y = 5, .w = 200, .h = 100, .table_w = 64, .table_h = 32 };
    double px, py;
    view.zoom = 3;
    view.centre_x = 20;
    view.centre_y = 10;
    view.turn = 90;
    wr_view_to_pixel(&view, 24, 10, &px, &py);
    assert_near(px, 17 + 100, 1e-12);
    assert_near(py, 5 + 50 + 3 * 4, 1e-12);
    wr_view_to_pixel(&view, 20, 12, &px, &py); /* and the bottom at the left */
    assert_near(px, 17 + 100 - 3 * 2, 1e-12);
    assert_near(py, 5 + 50, 1e-12);
}

/* By hand: copies in the adjacent column are half a cell lower, those in the next are not. */
static void copies_are_moved_by_half_a_cell(void **state)
{
    (void)state;
    WrCanvasView view = { .w = 200, .h = 100, .table_w = 30, .table_h = 22, .zoom = 2 };
    double px, py, x, y;
    view.centre_x = 15;
    view.centre_y = 11;
    view.tiling = WR_TILING_HALF_DROP;
    static const double drops[] = { 11, 0, 11, 0 };
    for (int i = -1; i <= 2; i++) {
        wr_view_to_pixel(&view, 30 * i + 7, 3, &px, &py);
        assert_near(px, 100 + 2 * (30 * i + 7 - 15), 1e-12);
        assert_near(py, 50 + 2 * (3 + drops[i + 1] - 11), 1e-12);
        wr_view_to_texel(&view, px, py, &x, &y);
        assert_near(x, 30 * i + 7, 1e-12);
        assert_near(y, 3, 1e-12);
    }
    view.tiling = WR_TILING_BRICK;
    wr_view_to_pixel(&view, 7, 3 + 22, &px, &py);
    assert_near(px, 100 + 2 * (7 + 15 - 15), 1e-12);
    assert_near(py, 50 + 2 * (3 + 22 - 11), 1e-12);
}

static void pixels_and_texels_stay_each_others_inverse(void **state)
{
    (void)state;
    TestRandom r = { 41 };
    for (int i = 0; i < 500; i++) {
        WrCanvasView view = random_view(&r, 37, 53);
        double px = 3 * WIDE * test_random(&r) - WIDE, py = 3 * TALL * test_random(&r) - TALL;
        double x, y, qx, qy;
        wr_view_to_texel(&view, px, py, &x, &y);
        wr_view_to_pixel(&view, x, y, &qx, &qy);
        assert_near(qx, px, 1e-8);
        assert_near(qy, py, 1e-8);
        wr_view_step_back(&view, px, py, &x, &y);
        wr_view_step(&view, x, y, &qx, &qy);
        assert_near(qx, px, 1e-9);
        assert_near(qy, py, 1e-9);
    }
}

/* Rotating, zooming and panning keep the position under the pointer, up to whole cells; also for centres moved back
   to the cell across shifted copies. */
static void what_is_under_the_pointer_stays_there(void **state)
{
    (void)state;
    TestRandom r = { 42 };
    for (int i = 0; i < 300; i++) {
        WrCanvasView view = random_view(&r, 37, 53);
        double px = WIDE * test_random(&r), py = TALL * test_random(&r), x0, y0, x1, y1;
        wr_view_to_texel(&view, px, py, &x0, &y0);
        double dx = 0, dy = 0;
        if (i % 3 == 0) wr_view_turn_at(&view, px, py, 1000 * test_random(&r) - 500);
        if (i % 3 == 1) wr_view_zoom_at(&view, px, py, exp2(6 * test_random(&r) - 1));
        if (i % 3 == 2) {
            dx = 900 * test_random(&r) - 450;
            dy = 900 * test_random(&r) - 450;
            wr_view_pan(&view, dx, dy);
        }
        wr_view_to_texel(&view, px + dx, py + dy, &x1, &y1);
        assert_near((x1 - x0) / 37 - rint((x1 - x0) / 37), 0, 1e-9);
        assert_near((y1 - y0) / 53 - rint((y1 - y0) / 53), 0, 1e-9);
        assert_true(fabs(view.turn) <= 180 && fabs(view.centre_x) <= 74 &&
                    fabs(view.centre_y) <= 106);
    }
}

/* ---- the picture ---- */

typedef struct Shown {
    SDL_Surface *surface;
    SDL_Renderer *renderer;
    WrRetainedFrame *kept;
    WrCanvas *canvas;
} Shown;

static Shown show_new(void)
{
    Shown s = { .surface =
                    SDL_CreateRGBSurfaceWithFormat(0, WIDE, TALL, 32, SDL_PIXELFORMAT_ARGB8888),
                .canvas = wr_canvas_new(2) };
    s.renderer = SDL_CreateSoftwareRenderer(s.surface);
    assert_non_null(s.renderer);
    s.kept = wr_retained_frame_new(s.renderer);
    return s;
}

static void show_free(Shown *s)
{
    wr_canvas_free(s->canvas);
    wr_retained_frame_free(s->kept);
    SDL_DestroyRenderer(s->renderer);
    SDL_FreeSurface(s->surface);
}

static void show(Shown *s, const WrCanvasView *view, const WrField *field)
{
    const WrCanvasDisplay look = { .colours = WR_CANVAS_SIGNED, .low = -1, .high = 1 };
    WrCanvasRange range;
    bool unfinished = true;
    while (unfinished) {
        wr_retained_frame_clear(s->kept, 0xff123456u);
        unfinished = wr_canvas_draw(s->canvas, s->kept, view, field, NULL, &look, WR_RANGE_RESTS,
                                    1.0, &range);
        wr_retained_frame_end(s->kept);
    }
}

static uint32_t pixel(const Shown *s, int i, int j)
{
    const uint32_t *row = (const uint32_t *)((const char *)s->surface->pixels +
                                             (size_t)j * (size_t)s->surface->pitch);
    return 0xff000000u | row[i];
}

static WrField *random_field(TestRandom *r, int w, int h)
{
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) wr_field_set(field, i, j, (float)(1.9 * test_random(r) - 0.95));
    return field;
}

/* The texel under a position of the window; false if another texel is closer than `reach` pixels. */
static bool texel_at(const WrCanvasView *view, const WrField *field, double px, double py,
                     double reach, float *height)
{
    const int w = view->table_w, h = view->table_h;
    for (int k = 0; k < 9; k++) {
        double x, y;
        wr_view_to_texel(view, px + reach * (k % 3 - 1), py + reach * (k / 3 - 1), &x, &y);
        float f = wr_field_get(field, (int)(x - floor(x / w) * w), (int)(y - floor(y / h) * h));
        if (k > 0 && f != *height) return false;
        *height = f;
    }
    return true;
}

static void assert_shown(const Shown *s, const WrCanvasView *view, const WrField *field,
                         double reach)
{
    int seen = 0;
    for (int j = 0; j < TALL; j++) {
        for (int i = 0; i < WIDE; i++) {
            float height = 0;
            if (!texel_at(view, field, i + 0.5, j + 0.5, reach, &height)) continue;
            seen++;
            /* a height between two codes may have either */
            if (pixel(s, i, j) != wr_canvas_colour(s->canvas, (double)height - 1e-6) &&
                pixel(s, i, j) != wr_canvas_colour(s->canvas, (double)height + 1e-6))
                fail_msg("pixel %d, %d at %g degrees, zoom %g, tiling %d: %08x, not %08x", i, j,
                         view->turn, view->zoom, (int)view->tiling, pixel(s, i, j),
                         wr_canvas_colour(s->canvas, (double)height));
        }
    }
    assert_true(seen > 500);
}

/* If one texel fills the whole footprint of a pixel, the pixel has its colour. */
static void every_pixel_shows_the_texel_under_it(void **state)
{
    (void)state;
    TestRandom r = { 43 };
    static const double quarters[] = { 0, 90, 180, -90 };
    for (int k = 0; k < 24; k++) {
        WrField *field = random_field(&r, 37 + 112 * (k % 2), 53 + 96 * (k % 2));
        Shown s = show_new();
        WrCanvasView view = random_view(&r, wr_field_width(field), wr_field_height(field));
        view.zoom = 12 + 8 * test_random(&r);
        if (k < 12) view.turn = quarters[k % 4], view.zoom = 3 + 2 * test_random(&r);
        view.tiling = (WrTiling)(k % 3);
        if (k % 2 && k % 3) { /* a shifted copy, and its border */
            view.centre_x = k % 3 == 1 ? 149 + 9 : 149 / 2.0 + 9;
            view.centre_y = k % 3 == 1 ? 149 / 2.0 + 9 : 149 + 9;
        }
        show(&s, &view, field);
        assert_shown(&s, &view, field, k < 12 ? 0.51 : 2.2);
        /* painting updates the same picture, on all its copies */
        for (int i = 0; i < 32 * 40; i++) /* all in one tile of nine */
            wr_field_set(field, i % 32, i / 32, (float)(1.9 * test_random(&r) - 0.95));
        show(&s, &view, field);
        assert_shown(&s, &view, field, k < 12 ? 0.51 : 2.2);
        show_free(&s);
        wr_field_free(field);
    }
}

/* Every pixel of an outline is on the outlined line of the table, on any copy. */
static void outlines_follow_the_copies(void **state)
{
    (void)state;
    TestRandom r = { 44 };
    const WrSelectPoint corners[4] = { { 0.2, 0.3 }, { 0.7, 0.3 }, { 0.7, 0.6 }, { 0.2, 0.6 } };
    for (int k = 0; k < 60; k++) {
        WrCanvasView view = random_view(&r, 37, 53);
        view.zoom = 1 + test_random(&r);
        WrMarchingAnts ants = { 0 };

        wr_marching_ants_add(&ants, corners, 4, 0, 0, &view, true, true);
        assert_true(ants.pixels.count > 50);
        for (int i = 0; i < ants.pixels.count; i++) {
            const SDL_Point *at = &ants.pixels.data[i].at;
            double u, v, off;
            wr_view_to_uv(&view, at->x + 0.5, at->y + 0.5, &u, &v);
            u -= floor(u);
            v -= floor(v);
            off = fmin(fmin(fabs(u - 0.2), fabs(u - 0.7)) * 37,
                       fmin(fabs(v - 0.3), fabs(v - 0.6)) * 53);
            if (off * view.zoom > 1.0) fail_msg("an ant is %g pixels off", off * view.zoom);
        }

        wr_marching_ants_free(&ants);
    }
}

/* ---- content of pixels ---- */

static void contours_are_few_and_at_round_heights(void **state)
{
    (void)state;
    TestRandom r = { 45 };
    for (int i = 0; i < 500; i++) {
        double low = 10 * test_random(&r) - 5, range = pow(10, 12 * test_random(&r) - 6);
        double step = wr_canvas_ink_step(low, low + range), lines = range / step;
        double digit = step / pow(10, floor(log10(step) + 1e-9));
        if (lines < 6 || lines > 18) fail_msg("%g lines over %g by %g", lines, range, step);
        assert_true(fabs(digit - 1) < 1e-9 || fabs(digit - 2) < 1e-9 || fabs(digit - 5) < 1e-9);
    }
    assert_near(wr_canvas_ink_step(0, 1), 0.1, 1e-12);
    assert_true(wr_canvas_ink_step(3, 3) > 0);
}

/* A ramp: a pixel belongs to a contour if its height and its left or upper neighbour's are not between the same two
   multiples. */
static void contours_lie_between_two_pixels_that_differ(void **state)
{
    (void)state;
    const WrCanvasDisplay look = { .colours = WR_CANVAS_CONTOURS };
    WrCanvasInk ink;
    wr_canvas_ink_make(&ink, &look, -0.31, 0.83);
    double step = ink.step;
    float rows[2][97];
    uint32_t out[97];
    int lines = 0;
    for (int i = 0; i < 97; i++) {
        rows[0][i] = (float)(0.0113 * i - 0.31);
        rows[1][i] = rows[0][i] + 0.0371F; /* more than horizontally */
    }
    wr_canvas_ink_heights(&ink, rows[1] + 1, rows[1][0], rows[0] + 1, 96, out);
    for (int i = 1; i < 97; i++) {
        double here = (double)rows[1][i], left = (double)rows[1][i - 1], over = (double)rows[0][i];
        bool line = false;
        uint32_t ink_of = 0;
        for (int k = -5; k < 10; k++) {
            if (!(left < k * step && here >= k * step) && !(over < k * step && here >= k * step))
                continue;
            /* zero, every fifth, and the others; each pixel has at most one here */
            line = true;
            ink_of = k == 0 ? 0xffc05a10u : k % 5 == 0 ? 0xff101010u : 0xff505860u;
        }
        lines += line;
        if (line && out[i - 1] != ink_of) fail_msg("pixel %d is %x", i, out[i - 1]);
        if (line != (out[i - 1] != wr_canvas_ink_colour(&ink, here))) fail_msg("pixel %d", i);
    }
    assert_true(lines >= 8);
}

static void reliefs_are_lit_by_the_cosine_and_level_ground_is_grey(void **state)
{
    (void)state;
    TestRandom r = { 46 };
    for (int i = 0; i < 100; i++) {
        double a = 6.283 * test_random(&r), reach = 0.4 + 0.55 * test_random(&r);
        const WrCanvasDisplay look = { .colours = WR_CANVAS_RELIEF,
                                       .light_x = reach * cos(a),
                                       .light_y = reach * sin(a) };
        double up = sqrt(1 - reach * reach), gamma = log(0.55) / log(up);
        float p[3] = { 0, (float)(6 * test_random(&r) - 3), 0 },
              q[3] = { 0, (float)(6 * test_random(&r) - 3), 0 };
        uint32_t out[3];
        WrCanvasInk ink;
        p[2] = (float)(-look.light_x / up); /* faces the light */
        q[2] = (float)(-look.light_y / up);
        wr_canvas_ink_make(&ink, &look, 0, 1);
        wr_canvas_ink_slopes(&ink, p, q, 3, out);
        double lit = (up - (double)p[1] * look.light_x - (double)q[1] * look.light_y) /
                     sqrt(1 + (double)p[1] * (double)p[1] + (double)q[1] * (double)q[1]);
        assert_near(out[0] & 0xff, 0.55 * 255, 1.0);
        assert_near(out[1] & 0xff, 255 * pow(fmax(lit, 0), gamma), 1.0 + 255 * gamma / 1024);
        assert_int_equal(out[2] & 0xff, 255);
    }
}

/* For a slope of 45 degrees to the right the normal leans to the left; also in the window, where an upward slope
   leans down. */
static void normals_have_the_colours_of_a_map(void **state)
{
    (void)state;
    const WrCanvasDisplay look = { .colours = WR_CANVAS_NORMALS, .high = 1 };
    WrCanvasView view = { .w = WIDE, .h = TALL, .table_w = 8, .table_h = 8, .zoom = 9 };
    WrCanvasRange range;
    Shown s = show_new();
    WrField *p = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 1, NULL);
    WrField *q = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    wr_retained_frame_clear(s.kept, 0xff123456u);
    wr_canvas_draw(s.canvas, s.kept, &view, p, q, &look, WR_RANGE_RESTS, 1, &range);
    wr_retained_frame_end(s.kept);
    assert_int_equal(pixel(&s, 100, 100), 0xff2580da); /* 127.5 (1 - 1/sqrt 2, 1, 1 + 1/sqrt 2) */
    wr_retained_frame_clear(s.kept, 0xff123456u);
    wr_canvas_draw(s.canvas, s.kept, &view, q, p, &look, WR_RANGE_RESTS, 1, &range);
    wr_retained_frame_end(s.kept);
    assert_int_equal(pixel(&s, 100, 100), 0xff8025da);
    wr_field_free(p);
    wr_field_free(q);
    show_free(&s);
}

/* ---- the range ---- */

/* Fields of two heights each. */
static WrField *two_heights(float low, float high)
{
    WrField *field = wr_field_new(16, 12, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, low, NULL);
    wr_field_set(field, 7, 5, high);
    return field;
}

static void assert_greys(Shown *s, const WrField *field, const WrCanvasDisplay *look,
                         WrRangeHold hold, double low, double high)
{
    const WrCanvasView view = { .w = WIDE, .h = TALL, .table_w = 16, .table_h = 12, .zoom = 9 };
    WrCanvasRange range;
    wr_canvas_draw(s->canvas, s->kept, &view, field, NULL, look, hold, 1, &range);
    if (range.low != low || range.high != high)
        fail_msg("shown: %g .. %g, not %g .. %g", range.low, range.high, low, high);
}

static void the_range_stays_during_edits_and_a_preview_widens_it_only_for_itself(void **state)
{
    (void)state;
    const WrCanvasDisplay look = { .automatic = { true, true } };
    WrField *before = two_heights(0.25f, 1), *raised = two_heights(0.25f, 3);
    WrField *tried = two_heights(-2, 5);
    Shown s = show_new();
    assert_greys(&s, before, &look, WR_RANGE_RESTS, 0.25, 1);
    const uint32_t grey = wr_canvas_colour(s.canvas, 0.5);
    assert_greys(&s, raised, &look, WR_RANGE_STAYS, 0.25, 1);
    assert_true(wr_canvas_colour(s.canvas, 0.5) == grey);
    assert_greys(&s, raised, &look, WR_RANGE_RESTS, 0.25, 3);
    assert_greys(&s, tried, &look, WR_RANGE_STAYS, 0.25, 3);
    assert_greys(&s, tried, &look, WR_RANGE_TRIES, -2, 5);
    assert_greys(&s, before, &look, WR_RANGE_STAYS, -2, 5); /* the preview is dragged on */
    assert_greys(&s, raised, &look, WR_RANGE_RESTS, 0.25, 3);
    wr_field_free(before);
    wr_field_free(raised);
    wr_field_free(tried);
    show_free(&s);
}

static void each_end_of_the_range_is_automatic_or_fixed(void **state)
{
    (void)state;
    WrCanvasDisplay look = { .automatic = { false, true }, .low = -7 };
    WrField *field = two_heights(0.25f, 1), *higher = two_heights(0.25f, 3);
    Shown s = show_new();
    assert_greys(&s, field, &look, WR_RANGE_RESTS, -7, 1);
    assert_greys(&s, higher, &look, WR_RANGE_RESTS, -7, 3);
    look = (WrCanvasDisplay){ .automatic = { true, false }, .high = 1.5 };
    assert_greys(&s, higher, &look, WR_RANGE_RESTS, 0.25, 1.5);
    look.high = -4; /* below all heights: still darker below than above */
    assert_greys(&s, higher, &look, WR_RANGE_RESTS, -5, -4);
    wr_field_free(field);
    wr_field_free(higher);
    show_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_quarter_turn_puts_right_below),
        cmocka_unit_test(copies_are_moved_by_half_a_cell),
        cmocka_unit_test(pixels_and_texels_stay_each_others_inverse),
        cmocka_unit_test(what_is_under_the_pointer_stays_there),
        cmocka_unit_test(every_pixel_shows_the_texel_under_it),
        cmocka_unit_test(outlines_follow_the_copies),
        cmocka_unit_test(contours_are_few_and_at_round_heights),
        cmocka_unit_test(contours_lie_between_two_pixels_that_differ),
        cmocka_unit_test(reliefs_are_lit_by_the_cosine_and_level_ground_is_grey),
        cmocka_unit_test(normals_have_the_colours_of_a_map),
        cmocka_unit_test(the_range_stays_during_edits_and_a_preview_widens_it_only_for_itself),
        cmocka_unit_test(each_end_of_the_range_is_automatic_or_fixed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
