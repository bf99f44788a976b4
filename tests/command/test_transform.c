/* The command transform: moving, rotating, scaling and copying the selection. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "field/select.h"

#include <math.h>

static const WrLayer *layer(const WrSession *s, int number)
{
    return &doc(s)->layers[number - 1];
}

/* Two layers, of which the second has coverage and a mask. */
static WrSession *layered(const char *table)
{
    return session_of((const char *[]){
        table, "pattern bricks", "layer add top", "stroke points=0.1,0.9;0.9,0.7,0.4 radius=19.7",
        "dab 0.93,0.1 radius=30.3 strength=1.7", "select ellipse centre=0.9,0.8 radii=0.4,0.3",
        "select feather by=3", "layer mask 2 from=selection", "select none", NULL });
}

static void whole_layers_go_as_table_operations_carry_them_to_the_bit(void **state)
{
    (void)state;
    const char *const same[][3] = {
        { "table 150x90", "transform move=17,-8", "adjust offset du=17 dv=-8" },
        { "table 150x90", "transform move=17,-8 layers=all",
          "adjust offset du=17 dv=-8 layers=all" },
        { "table 150x90", "transform scale=-1,1", "adjust flip-u" },
        { "table 151x90", "transform scale=1,-1 layers=all", "adjust flip-v layers=all" },
        { "table 91x91", "transform turn=90 layers=all", "adjust rotate angle=90" },
        { "table 90x90", "transform turn=-90 layers=all", "adjust rotate angle=270" },
        { "table 130x90", "transform turn=540 layers=all", "adjust rotate angle=180" },
    };
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        WrSession *a = layered(same[k][0]), *b = layered(same[k][0]);
        must_run(a, same[k][1]);
        must_run(b, same[k][2]);
        for (int n = 1; n <= 2; n++) {
            if (!same_field(layer(a, n)->heights, layer(b, n)->heights))
                fail_msg("%s: layer %d has other heights than by %s", same[k][1], n, same[k][2]);
            assert_true(n == 1 || same_field(layer(a, n)->cover, layer(b, n)->cover));
            assert_true(n == 1 || same_field(layer(a, n)->mask, layer(b, n)->mask));
        }
        wr_session_free(a);
        wr_session_free(b);
    }
}

/* A point of the piece and its image A + R S (p - A), computed here. A, the fixed point, is far from the piece's
   centre, so that a rotation in the other direction leads elsewhere; the table has several blocks, of which only
   those under the piece are computed. */
static void a_turn_about_a_far_point_leads_where_it_shall(void **state)
{
    (void)state;
    WrSession *s = session_of(
        (const char *[]){ "table 1031x777", "select rect from=0.5,0.4 to=0.7,0.6", "fill 1",
                          "transform turn=37 scale=1.3,1.9 about=0.45,0.35", NULL });
    const double c = cos(37 / 57.29577951308232), n = sin(37 / 57.29577951308232);
    for (int k = 0; k < 49; k++) {
        /* fractions of the piece's sides, inside for 0.2..0.8 and well outside for -0.4 and 1.4 */
        static const double parts[] = { -0.4, 0.2, 0.35, 0.5, 0.65, 0.8, 1.4 };
        const double a = parts[k % 7], b = parts[k / 7];
        const double x = (0.5 + 0.2 * a - 0.45) * 1031 * 1.3,
                     y = (0.4 + 0.2 * b - 0.35) * 777 * 1.9;
        const double u = 0.45 * 1031 + c * x - n * y, v = 0.35 * 777 + n * x + c * y;
        const bool inside = k % 7 > 0 && k % 7 < 6 && k / 7 > 0 && k / 7 < 6;
        assert_near(f_at(s, ((int)floor(u) + 1031) % 1031, 776 - ((int)floor(v) + 777) % 777),
                    inside ? 1.0 : 0.0, 1e-6);
    }
    wr_session_free(s);
}

static bool in_rect(int i, int j, int i0, int j0, int w, int h, int width, int height)
{
    int x = ((i - i0) % width + width) % width, y = ((j - j0) % height + height) % height;
    return x < w && y < h;
}

/* Columns 140..162 of 150, rows 80..97 of 90: over both edges. */
static void a_piece_goes_over_the_edges_and_leaves_the_ground(void **state)
{
    (void)state;
    for (int leave = 0; leave < 2; leave++) {
        WrSession *s = session_of(
            (const char *[]){ "table 150x90", "pattern bricks", "noise perlin seed=5", NULL });
        WrField *old = wr_field_share(layer(s, 1)->heights);
        char line[120];
        snprintf(line, sizeof line, "select rect from=%.17g,%.17g to=%.17g,%.17g", 140.0 / 150,
                 1 - 80.0 / 90, 163.0 / 150, 1 - 98.0 / 90);
        must_run(s, line);
        must_run(s, leave ? "transform move=-31,12 leave=on" : "transform move=-31,12");
        for (int j = 0; j < 90; j++)
            for (int i = 0; i < 150; i++) {
                bool here = in_rect(i, j, 109, 68, 23, 18, 150, 90);
                bool there = in_rect(i, j, 140, 80, 23, 18, 150, 90);
                float want = here              ? wr_field_get(old, (i + 31) % 150, (j + 12) % 90)
                             : there && !leave ? 0.0f
                                               : wr_field_get(old, i, j);
                assert_true(wr_field_get(layer(s, 1)->heights, i, j) == want);
                assert_true(wr_field_get(doc(s)->selection, i, j) == (float)here);
            }
        wr_field_free(old);
        wr_session_free(s);
    }
}

static void turned_and_scaled_heights_are_the_functions_own(void **state)
{
    (void)state;
    const struct {
        double turn, su, sv;
    } cases[] = { { 33.7, 1, 1 }, { -117, 1.7, 0.8 }, { 12.5, -0.9, 1.3 }, { 0, 1, 1.6 } };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        WrSession *s = session_of((const char *[]){ "table 256x200", NULL });
        char line[200];
        must_run(s, "formula fourier terms=2,1,0.31,40,10;1,3,0.23,70,200");
        WrField *old = wr_field_share(layer(s, 1)->heights);
        must_run(s, "select ellipse centre=0.6,0.45 radii=0.2,0.25");
        snprintf(line, sizeof line, "transform move=14.3,-6.1 turn=%g scale=%g,%g about=0.6,0.45",
                 cases[k].turn, cases[k].su, cases[k].sv);
        must_run(s, line);
        const double rad = cases[k].turn / 57.29577951308232, c = cos(rad), n = sin(rad);
        const double cx = 0.6 * 256, cy = 0.55 * 200; /* texels, rows down */
        int tried = 0;
        for (int j = 0; j < 200; j += 3)
            for (int i = 0; i < 256; i += 3) {
                double x = i + 0.5 - cx - 14.3, y = -(j + 0.5 - cy - 6.1); /* up */
                double px = (c * x + n * y) / cases[k].su, py = (-n * x + c * y) / cases[k].sv;
                if (hypot(px / (0.2 * 256), py / (0.25 * 200)) > 0.9) continue;
                double want = 0, sx = cx + px, sy = cy - py;
                /* Lagrange through four samples each way: another interpolation */
                int a = (int)floor(sx - 0.5), b = (int)floor(sy - 0.5);
                double fx = sx - 0.5 - a, fy = sy - 0.5 - b;
                for (int q = -1; q < 3; q++)
                    for (int p = -1; p < 3; p++) {
                        double wx = 1, wy = 1;
                        for (int m = -1; m < 3; m++) {
                            if (m != p) wx *= (fx - m) / (p - m);
                            if (m != q) wy *= (fy - m) / (q - m);
                        }
                        want += wx * wy *
                                (double)wr_field_get(old, ((a + p) % 256 + 256) % 256,
                                                     ((b + q) % 200 + 200) % 200);
                    }
                tried++;
                assert_near(wr_field_get(layer(s, 1)->heights, i, j), want, 6e-4);
            }
        assert_true(tried > 300);
        wr_field_free(old);
        wr_session_free(s);
    }
}

static void what_shrinks_is_averaged(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 256x256", "pattern checks across=62 rows=46",
                                                "transform scale=0.0625,0.0625", NULL });
    double sum = 0, most = 0;
    for (int j = 122; j < 134; j++)
        for (int i = 122; i < 134; i++) {
            double h = (double)f_at(s, i, j);
            sum += h;
            most = fmax(most, fabs(h - 0.5));
        }
    assert_near(sum / 144, 0.5, 0.02);
    assert_true(most < 0.1); /* nearest sampling would give 0 or 1 */
    assert_true(f_at(s, 5, 5) == 0);
    wr_session_free(s);
}

static void what_is_copied_can_be_pasted_to_the_bit(void **state)
{
    (void)state;
    WrSessionOptions options = { .outputs = true };
    WrSession *s = wr_session_new(&options);
    must_run(s, "table 150x90");
    must_run(s, "pattern bricks");
    must_fail(s, "copy nothing.png", "nothing.png");
    must_run(s, "select rect from=0.2,0.2 to=0.3,0.3");
    must_run(s, "select invert");
    must_run(s, "select none");
    char line[160];
    snprintf(line, sizeof line, "select rect from=%.17g,%.17g to=%.17g,%.17g", 140.0 / 150,
             1 - 20.0 / 90, 163.0 / 150, 1 - 38.0 / 90);
    must_run(s, line);
    must_run(s, "copy piece.exr");
    WrSession *other = session_of((const char *[]){ "table 200x120", "fill 0.25", NULL });
    snprintf(line, sizeof line, "picture paste piece.exr at=%.17g,%.17g", 61.5 / 200,
             1 - 39.0 / 120);
    must_run(other, line);
    for (int j = 0; j < 120; j++)
        for (int i = 0; i < 200; i++) {
            bool here = in_rect(i, j, 50, 30, 23, 18, 200, 120);
            float want = here
                             ? wr_field_get(layer(s, 1)->heights, (i - 50 + 140) % 150, j - 30 + 20)
                             : 0.25f;
            assert_true(f_at(other, i, j) == want);
        }
    must_fail(other, "picture paste piece.exr size=4000", "times the picture's 23 pixels");
    must_run(other, "undo");
    must_run(other, "picture paste piece.exr at=0.98,0.02 angle=37.3 size=60 mirror=u height=2");
    wr_session_free(other);
    wr_session_free(s);
}

/* Columns 140..162 of 150 and rows 80..97 of 90 are cut, and pasted to 190..212 of 200 and 110..127 of 120. */
static void what_is_cut_over_both_edges_is_pasted_over_them(void **state)
{
    (void)state;
    const WrSessionOptions options = { .outputs = true };
    WrSession *s = wr_session_new(&options);
    must_run(s, "table 150x90");
    must_run(s, "noise value cells=37 seed=3");
    WrField *old = wr_field_share(layer(s, 1)->heights);
    char line[160];
    snprintf(line, sizeof line, "select rect from=%.17g,%.17g to=%.17g,%.17g", 140.0 / 150,
             1 - 80.0 / 90, 163.0 / 150, 1 - 98.0 / 90);
    must_run(s, line);
    must_run(s, "copy cut.exr");
    must_run(s, "layer clear 1");
    WrSession *other = session_of((const char *[]){ "table 200x120", "fill 0.25", NULL });
    snprintf(line, sizeof line, "picture paste cut.exr at=%.17g,%.17g", 201.5 / 200,
             1 - 119.0 / 120);
    must_run(other, line);
    for (int j = 0; j < 120; j++)
        for (int i = 0; i < 200; i++) {
            const bool there = in_rect(i, j, 190, 110, 23, 18, 200, 120);
            const int x = (i - 190 + 200) % 200, y = (j - 110 + 120) % 120;
            assert_true(f_at(other, i, j) ==
                        (there ? wr_field_get(old, (140 + x) % 150, (80 + y) % 90) : 0.25f));
        }
    for (int j = 0; j < 90; j++)
        for (int i = 0; i < 150; i++)
            assert_true(f_at(s, i, j) ==
                        (in_rect(i, j, 140, 80, 23, 18, 150, 90) ? 0.0f : wr_field_get(old, i, j)));
    wr_field_free(old);
    wr_session_free(other);
    wr_session_free(s);
}

/* At its own position a copy covers the old heights in proportion to the selection at that time, across both edges,
   whatever is selected now. */
static void a_copy_becomes_a_layer_at_its_place(void **state)
{
    (void)state;
    const WrSessionOptions options = { .outputs = true };
    WrSession *s = wr_session_new(&options);
    must_run(s, "table 150x90");
    must_run(s, "noise value cells=37 seed=3");
    must_run(s, "select ellipse centre=0.95,0.1 radii=0.2,0.2");
    must_run(s, "select feather by=4");
    WrField *old = wr_field_share(layer(s, 1)->heights),
            *chosen = wr_field_share(doc(s)->selection);
    WrSelectBox box = { 0 };
    assert_true(wr_select_box(chosen, &box));
    must_run(s, "copy place.exr");
    must_run(s, "select none");
    must_run(s, "fill 0.25");
    must_run(s, "select rect from=0.4,0.4 to=0.5,0.5");
    const int before = wr_session_history_position(s);
    char line[160];
    snprintf(line, sizeof line, "layer paste place.exr at=%.17g,%.17g",
             (box.i + 0.5 * box.count_i) / 150, 1 - (box.j + 0.5 * box.count_j) / 90);
    must_run(s, line);
    assert_int_equal(wr_session_history_position(s), before + 1);
    assert_int_equal(doc(s)->layer_count, 2);
    assert_int_equal(doc(s)->active, 1);
    assert_null(doc(s)->selection);
    const WrField *all = wr_document_field(doc(s));
    for (int j = 0; j < 90; j++)
        for (int i = 0; i < 150; i++) {
            const double w = (double)wr_field_get(chosen, i, j);
            assert_near(wr_field_get(all, i, j),
                        0.25 + w * ((double)wr_field_get(old, i, j) - 0.25), 1e-6);
        }
    must_run(s, "undo");
    assert_int_equal(doc(s)->layer_count, 1);
    assert_non_null(doc(s)->selection);
    must_fail(s, "layer paste missing.exr", "missing.exr");
    must_fail(s, "layer paste place.exr size=100000", "must be");
    must_run(s, "layer set 1 lock=on"); /* the locked layer is not changed */
    must_run(s, "layer paste place.exr");
    wr_field_free(old);
    wr_field_free(chosen);
    wr_session_free(s);
}

static void the_box_of_a_selection_goes_over_edges(void **state)
{
    (void)state;
    const struct {
        const char *table, *line;
        int i, j, w, h;
        bool any;
    } cases[] = {
        { "table 100x50", "select rect from=0.9,0.9 to=1.2,1.1", 90, 45, 30, 10, true },
        { "table 100x50 wrap=clamp", "select rect from=0.5,0.2 to=0.7,0.6", 50, 20, 20, 20, true },
        { "table 100x50", "select all", 0, 0, 100, 50, true },
        { "table 100x50", "select height low=3 high=4", 0, 0, 0, 0, false },
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        WrSession *s = session_of((const char *[]){ cases[k].table, cases[k].line, NULL });
        WrSelectBox box = { 0 };
        assert_int_equal(wr_select_box(doc(s)->selection, &box), cases[k].any);
        if (cases[k].any) {
            assert_int_equal(box.i, cases[k].i);
            assert_int_equal(box.j, cases[k].j);
            assert_int_equal(box.count_i, cases[k].w);
            assert_int_equal(box.count_j, cases[k].h);
        } else must_fail(s, "transform turn=3", "nothing to move");
        wr_session_free(s);
    }
}

static void what_cannot_be_moved_is_refused(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 40x40", "layer add top", NULL });
    must_fail(s, "transform scale=0,1", "scale=0,1: must be 1/64 to 64");
    must_fail(s, "transform scale=1,0.01", "must be 1/64 to 64");
    must_run(s, "layer set 1 lock=on");
    must_fail(s, "transform move=1,1 layers=all", "is locked");
    must_run(s, "layer use 1");
    must_fail(s, "transform move=1,1", "is locked");
    wr_session_free(s);
}

/* A feathered, partly covered piece keeps its heights and its coverage where nothing is below. */
static void partly_covered_heights_stay_as_high(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 128x64", "layer add blend=max",
                                                "dab 0.2,0.5 radius=11.3 hardness=0.3", NULL });
    WrField *heights = wr_field_share(layer(s, 2)->heights),
            *cover = wr_field_share(layer(s, 2)->cover);
    must_run(s, "select rect from=0,0 to=0.5,1");
    must_run(s, "transform move=64,0");
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) {
            assert_true(wr_field_get(layer(s, 2)->cover, i + 64, j) == wr_field_get(cover, i, j));
            if (wr_field_get(cover, i, j) > 0)
                assert_near(wr_field_get(layer(s, 2)->heights, i + 64, j),
                            wr_field_get(heights, i, j), 1e-7);
            assert_true(wr_field_get(layer(s, 2)->cover, i, j) == 0);
        }
    wr_field_free(heights);
    wr_field_free(cover);
    wr_session_free(s);
}

/* Enlarged about its centre, a dab stays there: the images of a periodic table overlap, and the one enlarged about
   that point counts. */
static void what_is_enlarged_stays_about_its_point(void **state)
{
    (void)state;
    static const char *const lines[][2] = { { "layer add", "transform scale=3,3 about=0.25,0.75" },
                                            { "bump height=1",
                                              "transform scale=-3,-3 about=0.25,0.75" } };
    for (int k = 0; k < 2; k++) {
        WrSession *s = session_of((const char *[]){
            "table 64x64", lines[k][0], "dab 0.25,0.75 radius=4 hardness=1", lines[k][1], NULL });
        const WrField *f = wr_document_field(doc(s));
        for (int j = 0; j < 64; j++)
            for (int i = 0; i < 64;
                 i++) { /* three times the radius, about (16, 16), plus the filter's support */
                const double far = hypot(i + 0.5 - 16, j + 0.5 - 16);
                if (far < 9) assert_near(wr_field_get(f, i, j), 0.1, 0.02);
                if (far > 21) assert_true(wr_field_get(f, i, j) == 0.0f);
            }
        wr_session_free(s);
    }
}

/* A dab in the table's corner, on both edges, enlarged about it: its four parts stay together. */
static void content_over_the_edges_is_enlarged_in_one_piece(void **state)
{
    (void)state;
    WrSession *s =
        session_of((const char *[]){ "table 75x61", "dab 0,0 radius=6 hardness=1 strength=1",
                                     "transform scale=1.5,-1.5 about=1,0", NULL });
    for (int j = 0; j < 61; j++)
        for (int i = 0; i < 75; i++) {
            const double x = fmin(i + 0.5, 75 - i - 0.5), y = fmin(j + 0.5, 61 - j - 0.5);
            const double far = hypot(x, y); /* from the corner, across the edges */
            if (far < 7) assert_near(f_at(s, i, j), 1.0, 0.2);
            if (far > 13) assert_true(f_at(s, i, j) == 0.0f); /* 9, and the filter's support */
        }
    wr_session_free(s);
}

/* A copy of a whole layer's content covers the texels under its heights that are not 0, and no others. */
static void a_copy_of_a_layer_is_stamped_on_it(void **state)
{
    (void)state;
    static const char *const starts[] = { "bump height=1", "layer add top" };
    for (int k = 0; k < 2; k++) { /* without coverage, and with it */
        WrSession *s = session_of((const char *[]){ "table 75x61", starts[k], NULL });
        must_run(s, k ? "layer clear" : "fill 0");
        must_run(s, "dab 0.03,0.5 radius=9 hardness=1 strength=0.7");
        must_run(s, "dab 0.3,0.4 radius=8 hardness=0.9 strength=0.3");
        const WrLayer *top = layer(s, k + 1);
        assert_true((top->cover != NULL) == (k == 1));
        WrField *old = wr_field_share(top->heights);
        WrField *cover = top->cover ? wr_field_share(top->cover) : NULL;
        const int before = wr_session_history_position(s);
        must_run(s, "transform move=-17,4 leave=on");
        assert_int_equal(wr_session_history_position(s), before + 1);
        top = layer(s, k + 1);
        int stamped = 0;
        for (int j = 0; j < 61; j++)
            for (int i = 0; i < 75; i++) {
                const int x = (i + 17) % 75, y = (j + 4) % 61;
                const float high = wr_field_get(old, x, y);
                const double c = cover ? (double)wr_field_get(cover, x, y) : high != 0.0f;
                stamped += c > 0;
                if (c == 0.0)
                    assert_true(wr_field_get(top->heights, i, j) == wr_field_get(old, i, j));
                if (c == 1.0) assert_true(wr_field_get(top->heights, i, j) == high);
            }
        assert_in_range(stamped, 300, 700);
        must_run(s, "undo");
        assert_true(same_field(layer(s, k + 1)->heights, old));
        wr_field_free(old);
        wr_field_free(cover);
        wr_session_free(s);
    }
}

/* Several layers move as each does alone about the same point, in one step; others keep their bits. */
static void several_layers_move_together(void **state)
{
    (void)state;
    static const char *const moves[] = { "transform move=-13,8", "transform turn=90 about=0.3,0.45",
                                         "transform turn=33 scale=0.8,1.3 about=0.9,0.1" };
    for (size_t k = 0; k < sizeof moves / sizeof *moves; k++) {
        WrSession *a = layered("table 75x61"), *b = layered("table 75x61");
        WrSession *both[] = { a, b };
        for (int i = 0; i < 2; i++) {
            must_run(both[i], "layer use 1");
            must_run(both[i], "noise value cells=9 seed=4");
            must_run(both[i], "layer add third above=2");
            must_run(both[i], "dab 0.1,0.3 radius=13 strength=0.4");
            must_run(both[i], "layer add fourth above=3");
            must_run(both[i], "dab 0.2,0.7 radius=11 strength=0.4");
            must_run(both[i], "layer group pair of=3,4"); /* 5 */
        }
        const int before = wr_session_history_position(a);
        char line[120];
        snprintf(line, sizeof line, "%s of=pair,1", moves[k]);
        must_run(a, line);
        assert_int_equal(wr_session_history_position(a), before + 1);
        for (int n = 1; n <= 4; n++) {
            snprintf(line, sizeof line, "layer use %d", n);
            must_run(b, line);
            WrField *was = wr_field_share(layer(b, n)->heights);
            if (n != 2) must_run(b, moves[k]);
            assert_true(same_field(layer(a, n)->heights, layer(b, n)->heights));
            assert_int_equal(same_field(was, layer(b, n)->heights), n == 2);
            assert_true(n < 3 || same_field(layer(a, n)->cover, layer(b, n)->cover));
            wr_field_free(was);
        }
        must_run(a, "undo");
        must_fail(a, "transform move=1,1 of=1 layers=all", "of= or layers=all");
        must_fail(a, "transform move=1,1 of=1,9", "layer 9");
        must_run(a, "layer set 3 lock=on");
        must_fail(a, "transform move=1,1 of=1,pair", "is locked");
        wr_session_free(a);
        wr_session_free(b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_turn_about_a_far_point_leads_where_it_shall),
        cmocka_unit_test(whole_layers_go_as_table_operations_carry_them_to_the_bit),
        cmocka_unit_test(a_piece_goes_over_the_edges_and_leaves_the_ground),
        cmocka_unit_test(turned_and_scaled_heights_are_the_functions_own),
        cmocka_unit_test(what_shrinks_is_averaged),
        cmocka_unit_test(what_is_copied_can_be_pasted_to_the_bit),
        cmocka_unit_test(what_is_cut_over_both_edges_is_pasted_over_them),
        cmocka_unit_test(a_copy_becomes_a_layer_at_its_place),
        cmocka_unit_test(the_box_of_a_selection_goes_over_edges),
        cmocka_unit_test(what_cannot_be_moved_is_refused),
        cmocka_unit_test(partly_covered_heights_stay_as_high),
        cmocka_unit_test(what_is_enlarged_stays_about_its_point),
        cmocka_unit_test(content_over_the_edges_is_enlarged_in_one_piece),
        cmocka_unit_test(a_copy_of_a_layer_is_stamped_on_it),
        cmocka_unit_test(several_layers_move_together),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
