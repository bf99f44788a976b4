#include "test.h"

#include "base/error.h"
#include "base/progress.h"
#include "image/vector_drawing.h"
#include "export/line_drawing.h"

#include <math.h>
#include <string.h>

static WrLinesView view_of(int lines_u, int lines_v, double turn, double tilt)
{
    return (WrLinesView){ .lines_u = lines_u,
                          .lines_v = lines_v,
                          .turn_deg = turn,
                          .tilt_deg = tilt,
                          .relief = 1.0,
                          .width = 300,
                          .height = 200 };
}

static void a_flat_table_from_above_is_a_plain_grid(void **state)
{
    (void)state;
    float heights[16 * 16] = { 0 };
    WrLinesView view = view_of(5, 3, 0.0, 90.0);
    WrDrawing drawing;
    WrError err;
    assert_true(wr_lines_draw(heights, 16, 16, &view, NULL, &drawing, &err));
    assert_int_equal(drawing.stretch_count, 5 + 3);
    for (int s = 0; s < drawing.stretch_count; s++) {
        const WrVectorDrawingPoint *p = drawing.points + drawing.stretches[s].first;
        const WrVectorDrawingPoint *last = p + drawing.stretches[s].count - 1;
        for (int i = 0; i < drawing.stretches[s].count; i++)
            assert_true(fabs((double)(s < 5 ? p[i].y - p->y : p[i].x - p->x)) < 1e-4);
        /* 15/16 of a cell long in 300 x 200 minus 4 % at either end: the height is the limit */
        double length = hypot((double)(last->x - p->x), (double)(last->y - p->y));
        assert_true(fabs(length - 200.0 * 0.92) < 1e-3);
    }
    wr_drawing_fini(&drawing);
}

static void the_drawing_fits_its_frame_from_every_side(void **state)
{
    (void)state;
    float heights[12 * 20];
    for (int i = 0; i < 240; i++) heights[i] = (float)((i * 37) % 11) * 0.03f;
    for (int turn = -360; turn <= 360; turn += 45)
        for (int tilt = 0; tilt <= 90; tilt += 30) {
            WrLinesView view = view_of(12, 12, turn, tilt);
            WrDrawing drawing;
            WrError err;
            assert_true(wr_lines_draw(heights, 12, 20, &view, NULL, &drawing, &err));
            assert_true(drawing.stretch_count > 0);
            for (int i = 0; i < drawing.point_count; i++) {
                assert_true(drawing.points[i].x >= 300.0f * 0.04f - 0.01f &&
                            drawing.points[i].x <= 300.0f * 0.96f + 0.01f);
                assert_true(drawing.points[i].y >= 200.0f * 0.04f - 0.01f &&
                            drawing.points[i].y <= 200.0f * 0.96f + 0.01f);
            }
            wr_drawing_fini(&drawing);
        }
}

/* A wall along u of height h at v = w hides the floor behind it up to v = w + h / tan(tilt). */
static void a_wall_hides_just_the_floor_in_its_shadow(void **state)
{
    (void)state;
    enum {
        N = 64,
        WALL = 40
    }; /* the wall's row; rows run down, so rows below WALL are behind it */
    static float heights[N * N];
    memset(heights, 0, sizeof heights);
    for (int i = 0; i < N; i++) heights[WALL * N + i] = 0.1f;
    WrLinesView view = view_of(N, 0, 0.0, 30.0);
    WrLinesFrame frame;
    WrDrawing drawing;
    WrError err;
    assert_true(wr_lines_draw(heights, N, N, &view, &frame, &drawing, &err));
    double reach = 0.1 / tan(30.0 * acos(-1.0) / 180.0) * N; /* rows */
    for (int row = 0; row < N; row++) {
        double behind = WALL - row; /* rows */
        WrLinesPlace place =
            wr_lines_place(&frame, 0.5, 1.0 - (row + 0.5) / N, row == WALL ? 0.1 : 0.0);
        bool seen = false;
        for (int i = 0; i < drawing.point_count; i++)
            seen = seen || fabs((double)drawing.points[i].y - place.y) < 0.02;
        if (behind > 1.5 && behind < reach - 1.0) assert_false(seen);
        if ((behind <= 0.0 || behind > reach + 1.0) && !seen) fail_msg("row %d, %g", row, behind);
    }
    wr_drawing_fini(&drawing);
    view.hidden = true;
    assert_true(wr_lines_draw(heights, N, N, &view, NULL, &drawing, &err));
    assert_int_equal(drawing.stretch_count, N);
    wr_drawing_fini(&drawing);
}

static void a_single_texel_and_a_flat_edge_on_view_are_no_trouble(void **state)
{
    (void)state;
    float one = 3.0f, four[4] = { 0 };
    WrLinesView view = view_of(8, 8, 20.0, 30.0);
    WrDrawing drawing;
    WrError err;
    assert_true(wr_lines_draw(&one, 1, 1, &view, NULL, &drawing, &err));
    assert_int_equal(drawing.point_count, 0); /* a point has no lines */
    wr_drawing_fini(&drawing);
    view.tilt_deg = 0.0;
    assert_true(wr_lines_draw(four, 2, 2, &view, NULL, &drawing, &err));
    assert_true(drawing.stretch_count > 0);
    for (int i = 0; i < drawing.point_count; i++)
        assert_true(isfinite(drawing.points[i].x) && isfinite(drawing.points[i].y));
    wr_drawing_fini(&drawing);
}

/* At most the work of a row or a line is done between two cancellation checks. */
static void the_cancel_is_looked_at_row_by_row(void **state)
{
    (void)state;
    enum { SIDE = 256 };
    float *heights = calloc((size_t)SIDE * SIDE, sizeof *heights);
    WrLinesView view = view_of(9, 7, 30.0, 40.0);
    WrDrawing drawing;
    WrError err;
    int64_t before = wr_progress_checks();
    assert_true(wr_lines_draw(heights, SIDE, SIDE, &view, NULL, &drawing, &err));
    assert_true(wr_progress_checks() - before >= 2 * (SIDE - 1) + 9 + 7);
    wr_drawing_fini(&drawing);
    volatile int cancel = 1;
    const WrProgress told = { .cancel = &cancel };
    wr_progress_set(&told);
    assert_false(wr_lines_draw(heights, SIDE, SIDE, &view, NULL, &drawing, &err));
    wr_progress_set(NULL);
    assert_string_equal(err.text, "cancelled");
    free(heights);
}

static void a_picture_of_lines_looks_at_the_cancel_too(void **state)
{
    (void)state;
    enum { POINTS = 10000, HIGH = 300 };
    WrVectorDrawingPoint *points = calloc(POINTS, sizeof *points);
    WrError err;
    for (int i = 0; i < POINTS; i++)
        points[i] = (WrVectorDrawingPoint){ (float)(i % 400), (float)(i % 299) };
    WrVectorDrawing *ink = wr_vector_drawing_new("/nowhere/at/all.png", 400, HIGH, 1, &err);
    assert_non_null(ink);
    int64_t before = wr_progress_checks();
    wr_vector_drawing_line(ink, points, POINTS);
    assert_true(wr_progress_checks() - before >= POINTS / 256);
    before = wr_progress_checks();
    assert_false(wr_vector_drawing_write(ink, &err)); /* there is no such folder */
    assert_true(wr_progress_checks() - before >= HIGH);
    wr_vector_drawing_free(ink);
    free(points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_table_from_above_is_a_plain_grid),
        cmocka_unit_test(the_drawing_fits_its_frame_from_every_side),
        cmocka_unit_test(a_wall_hides_just_the_floor_in_its_shadow),
        cmocka_unit_test(a_single_texel_and_a_flat_edge_on_view_are_no_trouble),
        cmocka_unit_test(the_cancel_is_looked_at_row_by_row),
        cmocka_unit_test(a_picture_of_lines_looks_at_the_cancel_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
