/* Seam verdicts for cells of the generators: none for a whole cell, in every suitable tiling; a seam for a cut one;
   and the check of an exported file agrees with the export's report. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "export/check.h"
#include "field/seam_check.h"
#include "generate/generator.h"

/* Cells with several features in each direction, so that no single one is only at the edge. */
static const char *const cells[] = {
    "pattern bricks",
    "pattern bricks seed=7; adjust blur sigma=1.5",
    "pattern bricks bond=stack across=2 rows=3 wobble=0",
    "pattern bricks bond=flemish rows=6",
    "pattern bricks across=1 rows=1 bond=stack",
    "pattern tiles",
    "pattern tiles seed=7; adjust blur sigma=1.5",
    "pattern tiles across=1 rows=1",
    "pattern tiles across=2 rows=2 tilt=0 uneven=0 shape=octagon",
    "pattern tiles across=3 rows=3 shape=diamond",
    "pattern hexagons",
    "pattern hexagons seed=3; adjust blur sigma=1",
    "pattern planks",
    "pattern planks seed=7; adjust blur sigma=1.5",
    "pattern planks; adjust noise amount=0.05",
    "pattern shingles",
    "pattern shingles seed=7; adjust blur sigma=1.5",
    "pattern shingles rows=1",
    "pattern shingles rows=3",
    "pattern shingles rows=5 across=1",
    "pattern scales",
    "pattern scales rows=1",
    "pattern scales rows=3 across=2",
    "pattern scales seed=7; adjust blur sigma=1.5",
    "pattern weave",
    "pattern weave; adjust blur sigma=1.5",
    "pattern weave across=2 rows=2",
    "pattern rope",
    "pattern rope; adjust blur sigma=1.5",
    "pattern chain",
    "pattern chain; adjust blur sigma=1.5",
    "pattern grid",
    "pattern grid; adjust blur sigma=4",
    "pattern checks",
    "pattern checks; adjust blur sigma=1.5",
    "pattern stripes",
    "pattern stripes across=1 rows=0",
    "pattern waves",
    "pattern waves; adjust blur sigma=1.5",
    "pattern knurl",
    "pattern knurl; adjust blur sigma=1.5",
    "pattern dots",
    "pattern dots across=1 rows=1",
    "pattern dots seed=7; adjust blur sigma=1.5",
    "pattern voronoi",
    "pattern voronoi seed=7; adjust blur sigma=1.5",
    "pattern voronoi; adjust levels in-low=0.2 in-high=0.5",
    "pattern cracks",
    "pattern cracks seed=7; adjust blur sigma=1.5",
    "pattern scratches",
    "pattern scratches seed=7; adjust blur sigma=1.5",
    "noise perlin",
    "noise perlin cells=2 octaves=2",
    "noise perlin mode=turbulence",
    "noise perlin mode=ridged",
    "noise perlin mode=billow",
    "noise perlin cells=64 octaves=1",
    "noise perlin; adjust levels in-low=0 in-high=0.1",
    "noise gradient",
    "noise gradient cells=2 octaves=2",
    "noise gradient mode=turbulence",
    "noise value",
    "noise value cells=2 octaves=2",
    "noise value cells=96 octaves=1 fade=linear",
    "noise simplex cells=3",
    "noise sheared",
    "noise torus",
    "noise cubes",
    "noise torus mode=turbulence",
    "terrain fractal",
    "terrain fractal; terrain hydraulic",
    "terrain fractal; terrain thermal",
    "terrain fractal; terrain terraces",
    "grid",
    "fill 3.7",
};
#define CELLS ((int)(sizeof cells / sizeof *cells))

/* Lines are separated by "; ". */
static void run_lines(WrSession *session, const char *lines)
{
    char copy[200], *rest = copy;
    snprintf(copy, sizeof copy, "%s", lines);
    while (rest) {
        char *end = strstr(rest, "; ");
        if (end) *end = '\0';
        must_run(session, rest);
        rest = end ? end + 2 : NULL;
    }
}

static WrSession *session_with(const char *lines)
{
    WrSession *session = wr_session_new(NULL);
    must_run(session, "table 192x160");
    run_lines(session, lines);
    return session;
}

static WrField *part_of(const WrField *from, int x, int y, int w, int h)
{
    WrField *part = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(part, i, j,
                         wr_field_get(from, (x + i) % wr_field_width(from),
                                      (y + j) % wr_field_height(from)));
    return part;
}

static bool shows(const WrSeam *seam)
{
    return wr_seam_shows(&seam->u) || wr_seam_shows(&seam->v);
}

static void whole_cells_have_no_seam(void **state)
{
    (void)state;
    assert_true(CELLS >= 64);
    for (int k = 0; k < CELLS; k += test_step(1, 3)) {
        WrSession *session = session_with(cells[k]);
        const WrSeam seam = wr_seam_measure(wr_document_field(doc(session)), NULL);
        if (shows(&seam)) fail_msg("%s: orders %d and %d", cells[k], seam.u.order, seam.v.order);
        wr_session_free(session);
    }
}

/* Two thirds of a cell, cut where nothing repeats. Some of 70 cuts have edges no sharper than their interior: flat
 * ground, tiles and checks with straight steps. */
static void most_cuts_have_one_in_every_lay(void **state)
{
    (void)state;
    static const WrSeamOptions lays[] = { { { 0 }, { 0 }, 0 },
                                          { { 0 }, { 48, 0 }, 0 },
                                          { { 0 }, { 0, 50 }, 0 } };
    int missed[3] = { 0 }, tried = 0;
    for (int k = 0; k < CELLS; k += test_step(1, 3), tried++) {
        WrSession *session = session_with(cells[k]);
        WrField *cut = part_of(wr_document_field(doc(session)), 39, 33, 100, 96);
        for (int lay = 0; lay < 3; lay++) {
            const WrSeam seam = wr_seam_measure(cut, &lays[lay]);
            missed[lay] += !shows(&seam);
        }
        wr_field_free(cut);
        wr_session_free(session);
    }
    for (int lay = 0; lay < 3; lay++)
        if (10 * missed[lay] > tried)
            fail_msg("lay %d: %d of %d cuts were missed", lay, missed[lay], tried);
}

/* ---- files ---- */

/* The text in an export's report for a broken pattern; the scheme of these tables is C1. */
static bool is_torn(const char *report)
{
    static const char *const words[] = { "none, height differs", "none, second difference",
                                         "C0, slope changes", "C0, second difference" };
    for (int k = 0; k < 4; k++)
        if (strstr(report, words[k])) return true;
    return false;
}

static void agree(const char *path, const Said *said, const char *what)
{
    WrCheck check;
    WrError err = { "" };
    const unsigned seams = 1u << WR_CHECK_SEAM_U | 1u << WR_CHECK_SEAM_V;
    if (!wr_check_picture(path, -1, WR_CODING_AUTO, &check, &err)) fail_msg("%s", err.text);
    if (((check.problems & seams) != 0) != is_torn(said->text))
        fail_msg("%s, %s: check finds %s, the export said: %s", what, path,
                 check.problems & seams ? "a seam" : "none", said->text);
    if (check.problems & ~seams) fail_msg("%s, %s: problems %x", what, path, check.problems);
}

/* Every second cell is a cut, so that both verdicts occur. */
static void a_check_says_what_the_export_said(void **state)
{
    (void)state;
    static const char *const ways[] = { "height depth=8",
                                        "normal+y depth=8",
                                        "height depth=16 lay=half-drop",
                                        "normal-y depth=8 lay=brick repeat=2x1",
                                        "height depth=8 border=on",
                                        "curvature depth=8",
                                        "height depth=16 lay=hex",
                                        "normal+y depth=16 lay=half-drop resize=200x100",
                                        "occlusion depth=8" };
    int torn = 0, tried = 0;
    const int step = test_step(5, 9);
    for (int k = 0; k < CELLS; k += test_step(1, 3))
        for (int w = k % step; w < 9; w += step) {
            Said said = { "" };
            char line[200];
            WrSession *session = listening(&said);
            must_run(session, "table 192x160");
            run_lines(session, cells[k]);
            if (k % 2) must_run(session, "adjust crop x=39 y=33 width=100 height=96");
            said.text[0] = '\0';
            snprintf(line, sizeof line, "export %s c.png", ways[w]);
            must_run(session, line);
            agree("c.png", &said, cells[k]);
            torn += is_torn(said.text), tried++;
            wr_session_free(session);
        }
    assert_true(16 * torn > 5 * tried);
}

static void every_pattern_has_a_cell(void **state)
{
    (void)state;
    for (const WrGenerator *row = wr_patterns; row->family; row++) {
        char line[80];
        bool found = false;
        const int length = snprintf(line, sizeof line, "pattern %s", row->name);
        for (size_t k = 0; k < sizeof cells / sizeof *cells && !found; k++)
            found = strncmp(cells[k], line, (size_t)length) == 0 && strchr(" ;", cells[k][length]);
        if (!found) fail_msg("add cells of '%s'", line);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pattern_has_a_cell),
        cmocka_unit_test(whole_cells_have_no_seam),
        cmocka_unit_test(most_cuts_have_one_in_every_lay),
        cmocka_unit_test(a_check_says_what_the_export_said),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
