/* Hard cases of bent normals, filtered tables and sample means, as pictures under every setting of every dial: all
   values finite, coverage unchanged, unit normals, and a plan that changes no bit. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "hardcases/hardcases.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

enum { SIZE = 48, PIXELS = SIZE * SIZE };

/* A tested setting. */
typedef struct Trial {
    const char *id;
    const WrField *field;
    WrScene *scene; /* owned by the case */
    WrRenderer *renderer;
    double coverage; /* sum of A with the scene's own dials */
    char setting[128];
} Trial;

static void run_lines(WrSession *session, const char *at)
{
    while (*at) {
        char line[1024];
        WrError err = { "" };
        const size_t length = strcspn(at, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, at);
        if (!wr_session_run(session, line, &err)) fail_msg("%s: %s", line, err.text);
        at += length + (at[length] == '\n');
    }
}

static double sum_of_coverage(const float *rgba)
{
    double sum = 0.0;
    for (int i = 0; i < PIXELS; i++) sum += (double)rgba[4 * i + 3];
    return sum;
}

/* Colours are premultiplied: with coverage 0 they are 0. */
static void check_pixels(const Trial *trial, const float *rgba)
{
    for (int i = 0; i < PIXELS; i++) {
        const float *p = rgba + 4 * i;
        for (int c = 0; c < 4; c++)
            if (!isfinite(p[c]) || p[c] < 0.0f)
                fail_msg("%s %s: pixel %d, channel %d is %g", trial->id, trial->setting, i, c,
                         (double)p[c]);
        if (p[3] > 1.0f || (p[3] == 0.0f && p[0] + p[1] + p[2] > 0.0f))
            fail_msg("%s %s: pixel %d covers %g with %g", trial->id, trial->setting, i,
                     (double)p[3], (double)p[0]);
    }
}

/* Returns the number of pixels with a normal. Half-float members have an error of 2^-11, and so has |n'|. */
static int check_normals(const Trial *trial, const WrScene *scene, const float *normals)
{
    const double off = scene->dials.shading == WR_SHADING_HALF ? ldexp(1.01, -11) : 1e-5;
    int count = 0;
    for (int i = 0; i < PIXELS; i++) {
        const double x = (double)normals[3 * i], y = (double)normals[3 * i + 1];
        const double z = (double)normals[3 * i + 2], length = sqrt(x * x + y * y + z * z);
        if (length == 0.0) continue;
        if (!(fabs(length - 1.0) < off))
            fail_msg("%s %s: the normal of pixel %d is %g,%g,%g", trial->id, trial->setting, i, x,
                     y, z);
        count++;
    }
    return count;
}

/* The present scene, with the plan and without. */
static void check_scene(const Trial *trial, const WrScene *scene)
{
    static float planned[4 * PIXELS], normals[3 * PIXELS];
    WrError err = { "" };
    WrFrame frame;
    WrFrameRequest request = {
        .field = trial->field, .scene = scene, .width = SIZE, .height = SIZE, .normals = normals
    };
    normals[0] = 7.0f;
    if (!wr_renderer_frame(trial->renderer, &request, &frame, &err))
        fail_msg("%s %s: %s", trial->id, trial->setting, err.text);
    memcpy(planned, frame.rgba, sizeof planned);
    check_pixels(trial, planned);
    /* a coarse mesh, or other sample positions, move the silhouette by at most a pixel */
    assert_near(sum_of_coverage(planned), trial->coverage, 4.0 * SIZE);
    const int count = check_normals(trial, scene, normals);
    if (trial->coverage > 4.0 * SIZE) assert_true(count > 0);
    /* On the unit plane the scale-invariant formula equals the paper's up to rounding (E11), and pixels whose bound
       is under `contrast` may be refined or not (E16); everything else is bit-identical. */
    double allowed =
        scene->bump == WR_BUMP_INVARIANT && frame.plan->bump == WR_BUMP_BLINN ? 1e-5 : 0.0;
    if (scene->dials.aa == WR_AA_ADAPTIVE && scene->dials.refine == WR_REFINE_BOUND)
        allowed += scene->dials.contrast;
    /* Fast arithmetic rounds differently in one pass over a light than stage by stage; the bits are those of the
       plan. */
    if (scene->dials.arithmetic == WR_ARITHMETIC_FAST) allowed += 2e-4;
    request.full = true;
    request.normals = NULL;
    if (!wr_renderer_frame(trial->renderer, &request, &frame, &err))
        fail_msg("%s %s: %s", trial->id, trial->setting, err.text);
    for (int i = 0; i < 4 * PIXELS; i++)
        if (!(fabsf(planned[i] - frame.rgba[i]) <= (float)allowed))
            fail_msg("%s %s: the plan changes value %d from %g to %g", trial->id, trial->setting, i,
                     (double)frame.rgba[i], (double)planned[i]);
}

static void check_rung(Trial *trial, const WrDial *dial, double value)
{
    WrScene *scene = wr_scene_clone(trial->scene);
    dial->set(scene, value);
    /* a dial without effect by itself is tested with the first anti-aliasing method that uses it */
    for (int aa = 0; aa < WR_AA_COUNT && dial->matters && !dial->matters(scene); aa++)
        if (strcmp(dial->name, "aa") != 0) scene->dials.aa = (WrAntialias)aa;
    WrText text = { 0 };
    wr_dials_print(scene, "bump", false, &text);
    wr_dials_print(scene, "dials", false, &text);
    snprintf(trial->setting, sizeof trial->setting, "[%.100s]", wr_text_get(&text));
    wr_text_fini(&text);
    check_scene(trial, scene);
    wr_scene_free(scene);
}

static int check_dials(Trial *trial)
{
    int tried = 0;
    for (int d = 0; d < WR_DIAL_COUNT; d++) {
        const WrDial *dial = &wr_dials[d];
        for (int rung = 0; dial->rungs ? !isnan(dial->rungs[rung]) : rung < dial->choices; rung++) {
            check_rung(trial, dial, dial->rungs ? dial->rungs[rung] : rung);
            tried++;
        }
    }
    return tried;
}

static void check_case(const char *id, WrPool *pool)
{
    WrError err = { "" };
    const WrHardCase *row = wr_hardcase_find(id);
    assert_true(row && row->scene);
    WrSession *session = wr_session_new(NULL);
    run_lines(session, row->scene);
    const WrDocument *document = wr_session_document(session);
    Trial trial = { .id = id,
                    .field = wr_document_field(document),
                    .scene = wr_scene_clone(document->scene),
                    .renderer = wr_renderer_new(pool, NULL, &err) };
    assert_non_null(trial.renderer);
    WrFrameRequest request = {
        .field = trial.field, .scene = trial.scene, .width = SIZE, .height = SIZE
    };
    WrFrame frame;
    if (!wr_renderer_frame(trial.renderer, &request, &frame, &err)) fail_msg("%s", err.text);
    trial.coverage = sum_of_coverage(frame.rgba);
    assert_true(check_dials(&trial) > 40);
    wr_renderer_free(trial.renderer);
    wr_scene_free(trial.scene);
    wr_session_free(session);
}

static void check_cases(const char *const *ids)
{
    WrPool *pool = wr_pool_new(2);
    for (; *ids; ids++) check_case(*ids, pool);
    wr_pool_free(pool);
}

static void hc12_to_hc19_under_every_setting(void **state)
{
    (void)state;
    static const char *const ids[] = { "HC12", "HC13", "HC14", "HC15", "HC16",
                                       "HC17", "HC18", "HC19", NULL };
    check_cases(ids);
}

/* HC20 and HC21 concern single vectors: every frame's normals cover them. */
static void hc22_to_hc27_under_every_setting(void **state)
{
    (void)state;
    static const char *const ids[] = { "HC22", "HC23", "HC24", "HC25", "HC26", "HC27", NULL };
    check_cases(ids);
}

static void hc55_and_hc56_under_every_setting(void **state)
{
    (void)state;
    static const char *const ids[] = { "HC55", "HC56", NULL };
    check_cases(ids);
}

static void hc92_to_hc94_under_every_setting(void **state)
{
    (void)state;
    static const char *const ids[] = { "HC92", "HC93", "HC94", NULL };
    check_cases(ids);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc12_to_hc19_under_every_setting),
        cmocka_unit_test(hc22_to_hc27_under_every_setting),
        cmocka_unit_test(hc55_and_hc56_under_every_setting),
        cmocka_unit_test(hc92_to_hc94_under_every_setting),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
