/* test_slopes_import.c - slopes and bump slopes converted back to heights, with the scale in their files. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "command/session.h"

#include <math.h>
#include <unistd.h>

enum { W = 45, H = 63 }; /* odd: central differences then lose only the level */

static WrSession *rough_table(Said *said)
{
    WrSession *s = listening(said);
    must_run(s, "table 45x63");
    must_run(s, "noise perlin cells=3 octaves=3 amplitude=2.3 level=-1.1 seed=5");
    must_run(s, "bump height=0.37");
    must_run(s, "cell 2.5,1.5");
    return s;
}

static double range_of(const WrSession *s)
{
    float low, high;
    wr_field_range(wr_document_field(doc(s)), &low, &high);
    return (double)(high - low);
}

/* The largest difference up to a constant, relative to the range. */
static double farthest(const WrSession *a, const WrSession *b)
{
    double low = INFINITY, high = -INFINITY;
    for (int k = 0; k < W * H; k++) {
        const double d = (double)f_at(a, k % W, k / W) - (double)f_at(b, k % W, k / W);
        low = fmin(low, d), high = fmax(high, d);
    }
    return (high - low) / range_of(a);
}

typedef struct Case {
    const char *write, *read;
    double most; /* parts of the range */
} Case;

static void come_back(const Case *cases, int count)
{
    for (int k = 0; k < count; k++) {
        Said said, other;
        WrSession *s = rough_table(&said), *back = listening(&other);
        must_run(back, "table 45x63");
        must_run(s, cases[k].write);
        must_run(back, cases[k].read);
        assert_int_equal(wr_field_height(wr_document_field(doc(back))), H);
        const double far = farthest(s, back);
        if (!(far <= cases[k].most))
            fail_msg("%s: %g of the range: %s", cases[k].read, far, other.text);
        wr_session_free(back);
        wr_session_free(s);
    }
}

static void slopes_become_heights_by_their_label(void **state)
{
    (void)state;
    static const Case cases[] = {
        { "export slopes s.exr scheme=central", "image s.exr", 1e-5 },
        { "export slopes s.tif scheme=central", "image s.tif", 1e-5 },
        { "export slopes s.raw scheme=central endian=big", "image s.raw", 1e-5 },
        { "export slopes s.exr scheme=central depth=16", "image s.exr", 4e-3 },
        { "export slopes s.exr scheme=bspline-fit cell=4,7", "image s.exr", 0.012 },
    };
    come_back(cases, 5);
}

static void bump_slopes_become_heights_too(void **state)
{
    (void)state;
    static const Case cases[] = {
        { "export bump-slopes b.exr", "image b.exr", 0 },
        { "export bump-slopes b.exr", "picture normals b.exr codes=bump-slopes slopes=central",
          1e-5 },
        { "export bump-slopes b.exr signs=renderman",
          "picture normals b.exr slopes=central cell=3,4 height=2", 1e-5 },
        { "export bump-slopes b.exr uvslopes=256", "picture normals b.exr slopes=central", 1e-5 },
        { "export bump-slopes b.exr scheme=bspline-fit", "picture normals b.exr", 0.012 },
    };
    come_back(cases, 5);
}

/* Their border is wrong, so heights are close but not exact. */
static void so_do_those_of_maketx(void **state)
{
    (void)state;
    if (system("maketx --help 2>&1 | grep -q -e --bumpslopes") != 0) skip();
    Said said, other;
    WrSession *s = rough_table(&said), *back = listening(&other);
    must_run(s, "export height h.exr");
    assert_int_equal(system("maketx --bumpslopes h.exr -o m.exr >/dev/null"), 0);
    must_run(back, "table 45x63");
    must_run(back, "picture normals m.exr codes=bump-slopes");
    assert_true(farthest(s, back) < 0.2);
    wr_session_free(back);
    wr_session_free(s);
}

static void what_is_no_slopes_is_refused(void **state)
{
    (void)state;
    Said said;
    WrSession *s = rough_table(&said);
    must_run(s, "export height h.exr");
    must_fail(s, "picture normals h.exr codes=slopes", "two channels");
    must_fail(s, "picture normals h.exr codes=bump-slopes", "b1_dhds");
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slopes_become_heights_by_their_label),
        cmocka_unit_test(bump_slopes_become_heights_too),
        cmocka_unit_test(so_do_those_of_maketx),
        cmocka_unit_test(what_is_no_slopes_is_refused),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
