/* Tolerances on random sums of sines: if a choice claims to meet its tolerance, the picture measured against the
   reference must meet it. WR_SINES=FIRST,COUNT measures other scenes and prints every row. */
#include "test.h"
#include "session_help.h"

#include "accuracy/metrics.h"
#include "accuracy/tolerance.h"
#include "base/text.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>

#define SIDE 64  /* pixels */
#define FINE 32  /* samples along a side in the reference; twice those of the finest choice */
#define COUNT 12 /* scenes */

static const WrTolerance tolerances[] = { { WR_TOLERANCE_MAX, 0.3 },  { WR_TOLERANCE_MAX, 0.1 },
                                          { WR_TOLERANCE_MAX, 0.06 }, { WR_TOLERANCE_MAX, 0.03 },
                                          { WR_TOLERANCE_MAX, 0.01 }, { WR_TOLERANCE_RMS, 0.03 },
                                          { WR_TOLERANCE_RMS, 0.01 }, { WR_TOLERANCE_RMS, 0.003 } };

/* ---- scenes ---- */

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    uint64_t x = *state;
    x ^= x >> 33, x *= 0xff51afd7ed558ccdu, x ^= x >> 33;
    return (double)(x >> 11) * 0x1p-53;
}

static double between(uint64_t *state, double low, double high)
{
    return low + (high - low) * uniform(state);
}

/* Uniform in the logarithm. */
static double scaled(uint64_t *state, double low, double high)
{
    return low * pow(high / low, uniform(state));
}

static void add_terms(WrText *text, uint64_t *state)
{
    const int count = 1 + (int)(5 * uniform(state));
    const double most = scaled(state, 2, 45);
    for (int i = 0; i < count; i++)
        wr_text_addf(text, "%s%d,%d,%.17g,%.17g,%.17g", i > 0 ? ";" : "",
                     (int)between(state, -most, most), (int)between(state, 0, most),
                     between(state, 0.05, 0.6), between(state, 0, 360), between(state, 0, 360));
}

/* A session of scene number n. */
static WrSession *scene_of(int n)
{
    static const char *const surfaces[] = { "plane",  "plane a=1.7 b=1.1",
                                            "sphere", "cylinder",
                                            "torus",  "bent",
                                            "ribbon", "disc",
                                            "cone",   "cube",
                                            "plane",  "sphere" };
    uint64_t state = (uint64_t)n * 0x9e3779b97f4a7c15u + 1;
    WrSession *session = wr_session_new(NULL);
    WrText line = { 0 };
    uniform(&state);
    const bool table = uniform(&state) < 0.3;
    must_run(session, table ? "table 256x256" : "table 16x16");
    wr_text_add(&line, table ? "formula fourier terms=" : "analytic fourier terms=");
    add_terms(&line, &state);
    must_run(session, wr_text_get(&line));
    wr_text_clear(&line);
    wr_text_addf(&line, "surface %s", surfaces[(int)(12 * uniform(&state))]);
    must_run(session, wr_text_get(&line));
    wr_text_clear(&line);
    wr_text_addf(&line, "rotate %.17g,%.17g,%.17g", between(&state, -75, 75),
                 between(&state, -60, 60), between(&state, -40, 40));
    if (uniform(&state) < 0.75) must_run(session, wr_text_get(&line));
    wr_text_clear(&line);
    wr_text_addf(&line, "bump mode=%s height=%.17g", uniform(&state) < 0.7 ? "blinn" : "exact",
                 scaled(&state, 0.001, 0.05));
    must_run(session, wr_text_get(&line));
    wr_text_clear(&line);
    wr_text_addf(&line, "material ambient=%.3g diffuse=%.3g specular=%.3g shininess=%.3g",
                 between(&state, 0, 0.1), between(&state, 0.3, 1),
                 uniform(&state) < 0.3 ? 0 : between(&state, 0, 0.7), scaled(&state, 4, 150));
    must_run(session, wr_text_get(&line));
    wr_text_clear(&line);
    if (uniform(&state) < 0.5) {
        wr_text_addf(&line, "light directional to=%.17g,%.17g,%.17g", between(&state, -1, 1),
                     between(&state, -1, 1), between(&state, 0.2, 1));
        must_run(session, "light clear");
        must_run(session, wr_text_get(&line));
    }
    wr_text_fini(&line);
    return session;
}

/* ---- the promise ---- */

typedef struct Tally {
    int rows, claimed, broken, unresolved;
    double samples; /* of all pictures, relative to one per covered pixel */
} Tally;

static void measure(WrRenderer *renderer, WrFrameRequest *request, WrScene *scene,
                    const WrReference *reference, int n, bool print, Tally *tally)
{
    for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++) {
        const WrTolerance *tolerance = &tolerances[t];
        const bool rms = tolerance->kind == WR_TOLERANCE_RMS;
        WrError err;
        WrFrame frame;
        WrErrors errors;
        WrChoice choice = { 0 };
        scene->tolerance = *tolerance;
        if (!wr_tolerance_choose(renderer, request, &choice, &frame, &err))
            fail_msg("%s", err.text);
        wr_errors_measure(frame.rgba, NULL, reference, NULL, &errors);
        const double got = rms ? errors.rms : errors.max;
        const double unsure = rms ? reference->last_rms : reference->last_max;
        const bool resolved = unsure <= 0.5 * tolerance->value;
        const bool broken = choice.met && resolved && got > tolerance->value;
        tally->rows++;
        tally->claimed += choice.met;
        tally->unresolved += choice.met && !resolved;
        tally->broken += broken;
        const double made = (double)frame.shaded / fmax(1, (double)frame.covered);
        tally->samples += made;
        if (print)
            printf("%d %s=%g met=%d est=%.4g true=%.4g ref=%.2g samples=%.1f%s\n", n,
                   rms ? "rms" : "max", tolerance->value, choice.met, rms ? choice.rms : choice.max,
                   got, unsure, made, broken ? " BROKEN" : "");
        wr_choice_fini(&choice);
    }
}

static void random_sums_of_sines_keep_to_their_tolerances(void **unused)
{
    (void)unused;
    int first = 1, count = COUNT;
    const char *wanted = getenv("WR_SINES");
    const bool print = wanted && sscanf(wanted, "%d,%d", &first, &count) == 2;
    Tally tally = { 0 };
    for (int n = first; n < first + count; n += print ? 1 : test_step(3, 3)) {
        WrError err;
        WrSession *session = scene_of(n);
        WrScene *scene = wr_scene_clone(doc(session)->scene);
        WrRenderer *renderer = wr_renderer_new(NULL, NULL, &err);
        assert_non_null(renderer);
        WrReference reference = { 0 };
        WrFrameRequest request = { .field = wr_document_composite(doc(session), NULL),
                                   .scene = scene,
                                   .width = SIDE,
                                   .height = SIDE };
        const WrReferenceRequest fine = { .field = request.field,
                                          .scene = scene,
                                          .width = SIDE,
                                          .height = SIDE,
                                          .first = FINE / 2,
                                          .most = FINE };
        assert_true(wr_reference_render(&fine, NULL, &reference, &err));
        measure(renderer, &request, scene, &reference, n, print, &tally);
        fflush(stdout);
        wr_reference_fini(&reference);
        wr_renderer_free(renderer);
        wr_scene_free(scene);
        wr_session_free(session);
    }
    printf("%d scenes, %d rows, %d claimed, %d unresolved, %d broken, %.0f samples\n", count,
           tally.rows, tally.claimed, tally.unresolved, tally.broken, tally.samples);
    if (!print) assert_int_equal(tally.broken, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_sums_of_sines_keep_to_their_tolerances),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
