/* Reliefs along edges: heights by the distance from them. */
#include "test.h"
#include "session_help.h"

#include "base/error.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"

#include <math.h>

/* The heights of each kind at d texels inside a straight edge, of width 10 and height 2. */
static double profile(const char *kind, double d)
{
    double t = fmin(fmax(d / 10, 0), 1);
    if (strcmp(kind, "bevel") == 0) return 2 * t;
    if (strcmp(kind, "round") == 0) return 2 * sqrt(1 - (1 - t) * (1 - t));
    if (strcmp(kind, "ridge") == 0) return 2 * fmax(d, 0) / 10;
    if (strcmp(kind, "outline") == 0) return fabs(d) < 5 ? 2 * sqrt(1 - d * d / 25) : 0;
    t = fmin(fmax((d + 10) / 20, 0), 1);
    return 2 * t * t * (3 - 2 * t);
}

static const char *const kinds[] = { "bevel", "round", "ridge", "outline", "emboss" };

static void a_disc_over_the_edges_has_the_profile_of_its_radius(void **state)
{
    (void)state;
    for (int k = 0; k < 5; k++) {
        WrSession *s = session_of((const char *[]){
            "table 150x120", "select ellipse centre=0.95,0.05 radii=0.2,0.25", NULL });
        char line[80];
        snprintf(line, sizeof line, "rim kind=%s width=10 height=2", kinds[k]);
        must_run(s, line);
        for (int j = 0; j < 120; j++)
            for (int i = 0; i < 150; i++) {
                double x = i + 0.5 - 0.95 * 150, y = j + 0.5 - 0.95 * 120;
                x -= 150 * rint(x / 150);
                y -= 120 * rint(y / 120);
                double d = 30 - hypot(x, y);
                /* at a kink a texel is a mean: of the profiles over one texel */
                bool kink = fabs(d) < 1.6 || fabs(fabs(d) - 5) < 1.6 || fabs(d - 10) < 1.6;
                double most = kink ? 0.5 : 0.06;
                if (d < 1 && strcmp(kinds[k], "outline") != 0 && strcmp(kinds[k], "emboss") != 0 &&
                    d > -1)
                    continue;
                assert_near(f_at(s, i, j), profile(kinds[k], d), most);
            }
        wr_session_free(s);
    }
}

/* A band around the table has two edges and no ends. */
static void a_band_round_the_table_has_no_ends(void **state)
{
    (void)state;
    const char *const ways[] = { "select rect from=-0.5,0.25 to=0.5,0.75",
                                 "select rect from=0.25,-0.5 to=0.75,0.5" };
    for (int way = 0; way < 2; way++) {
        WrSession *s = session_of((const char *[]){ "table 80x80", ways[way],
                                                    "rim kind=bevel width=7.5 height=1", NULL });
        for (int j = 0; j < 80; j++)
            for (int i = 0; i < 80; i++) {
                double at = (way ? i : j) + 0.5, d = fmin(at - 20, 60 - at);
                double want = fmin(fmax(d, 0) / 7.5, 1);
                bool kink = fabs(d) < 1 || fabs(d - 7.5) < 1;
                assert_near(f_at(s, i, j), want, kink ? 0.07 : 1e-5);
            }
        wr_session_free(s);
    }
}

static void edges_come_from_masks_and_heights_too(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 90x70", "layer add top",
                                                "select ellipse centre=0.4,0.5 radii=0.2,0.3",
                                                "layer mask 2 from=selection", NULL });
    must_run(s, "rim of=selection width=9");
    WrField *want = wr_field_share(doc(s)->layers[1].heights);
    must_run(s, "undo");
    must_run(s, "select none");
    must_run(s, "rim of=mask width=9");
    assert_true(same_field(want, doc(s)->layers[1].heights));
    must_run(s, "undo");
    must_fail(s, "rim of=selection", "nothing is selected");
    must_run(s, "layer mask 2 from=none");
    must_fail(s, "rim of=mask", "the layer has no mask");
    must_run(s, "layer add third");
    must_run(s, "select ellipse centre=0.4,0.5 radii=0.2,0.3");
    must_run(s, "fill 4");
    must_run(s, "select none");
    must_run(s, "rim of=heights level=2 width=9 blend=replace");
    for (int j = 0; j < 70; j++)
        for (int i = 0; i < 90; i++)
            if (wr_field_get(want, i, j) > 0.2f)
                assert_near(wr_field_get(doc(s)->layers[2].heights, i, j), wr_field_get(want, i, j),
                            1e-5);
    wr_field_free(want);
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_disc_over_the_edges_has_the_profile_of_its_radius),
        cmocka_unit_test(a_band_round_the_table_has_no_ends),
        cmocka_unit_test(edges_come_from_masks_and_heights_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
