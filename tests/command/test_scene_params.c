/* Scene parameters: values of a new scene, arguments and output of commands, inputs of the plan. */
#include "test.h"
#include "session_help.h"

#include "base/error.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "command/session_internal.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "render/plan/plan.h"
#include "scene/param.h"
#include "scene/material_preset.h"
#include "scene/scene.h"

#include <string.h>

static void *owner_of(const WrSceneParam *param, WrScene *scene)
{
    return param->of_light ? (void *)&scene->lights[0] : scene;
}

static void ranges_defaults_and_words_are_sound(void **state)
{
    (void)state;
    for (int i = 0; i < WR_SCENE_PARAM_COUNT; i++) {
        const WrSceneParam *p = &wr_scene_params[i];
        assert_non_null(p->help);
        assert_true(p->components >= 0 && p->components <= 3);
        for (int k = 0; k < p->components; k++) {
            assert_true(p->low < p->high);
            assert_true(p->fallback[k] >= p->low && p->fallback[k] <= p->high);
        }
        if (p->components == 1 && p->label) {
            assert_true(p->soft_low < p->soft_high);
            assert_true(p->soft_low >= p->low && p->soft_high <= p->high);
            assert_true(!p->logarithmic || p->soft_low > 0);
        }
        const size_t size = p->components ? (size_t)p->components * sizeof(double) : sizeof(bool);
        assert_true(p->place + size <= (p->of_light ? sizeof(WrLight) : sizeof(WrScene)));
        for (int j = 0; j < i; j++) { /* no duplicates */
            const WrSceneParam *q = &wr_scene_params[j];
            assert_false(strcmp(p->command, q->command) == 0 && strcmp(p->name, q->name) == 0);
        }
    }
}

/* Ordinary values within the range. */
static void draw(TestRandom *random, const WrSceneParam *p, double *values)
{
    const double low = p->low > -50 ? p->low : -50, high = p->high < 50 ? p->high : 50;
    values[0] = test_random(random) < 0.5;
    for (int k = 0; k < p->components; k++) values[k] = low + (high - low) * test_random(random);
}

static void write_line(const WrSceneParam *p, const double *values, WrText *line)
{
    const char *form = p->form                             ? p->form
                       : p->of_light                       ? "point at=3,1,2"
                       : strcmp(p->command, "camera") == 0 ? "perspective"
                                                           : "";
    wr_text_addf(line, "%s %s ", p->command, form);
    if (!p->positional) wr_text_addf(line, "%s=", p->name);
    if (p->components == 0) wr_text_add(line, values[0] != 0 ? "on" : "off");
    for (int k = 0; k < p->components; k++) {
        if (k) wr_text_add(line, ",");
        wr_text_add_number(line, values[k]);
    }
}

static void assert_set(const WrScene *scene, int index, const double *values, const char *line)
{
    const WrSceneParam *p = &wr_scene_params[index];
    double got[3];
    wr_scene_param_get(p, owner_of(p, (WrScene *)scene), got);
    for (int k = 0; k < (p->components ? p->components : 1); k++)
        if (got[k] != values[k]) fail_msg("%s: number %d is %.17g", line, k, got[k]);
    for (int j = 0; j < WR_SCENE_PARAM_COUNT; j++) { /* and no other parameter */
        const WrSceneParam *q = &wr_scene_params[j];
        if (j == index || q->of_light || q->place == p->place) continue;
        const double *want = q->fallback, off = 0;
        if (index == WR_SCENE_PARAM_EYE && j == WR_SCENE_PARAM_FIT) want = &off;
        wr_scene_param_get(q, scene, got);
        for (int k = 0; k < (q->components ? q->components : 1); k++)
            if (got[k] != want[k]) fail_msg("%s: %s is %g", line, q->name, got[k]);
    }
}

/* A new session after the lines that restore a scene. */
static WrSession *restored(const WrScene *scene)
{
    WrSession *session = wr_session_new(NULL);
    WrText text = { 0 };
    wr_print_identity(scene, &text);
    char *lines = text.data, *next;
    for (; lines && *lines; lines = next) {
        next = strchr(lines, '\n');
        if (next) *next++ = '\0';
        must_run(session, lines);
    }
    wr_text_fini(&text);
    return session;
}

static void each_is_set_by_its_command_and_printed_again(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    for (int i = 0; i < WR_SCENE_PARAM_COUNT; i++) {
        const WrSceneParam *p = &wr_scene_params[i];
        WrText line = { 0 };
        double values[3];
        draw(&random, p, values);
        write_line(p, values, &line);
        WrSession *session = wr_session_new(NULL);
        if (strcmp(p->command, "environment") == 0) must_run(session, "environment raking");
        must_run(session, wr_text_get(&line));
        assert_set(doc(session)->scene, i, values, wr_text_get(&line));
        WrSession *other = restored(doc(session)->scene);
        assert_set(doc(other)->scene, i, values, "printed again");
        wr_session_free(other);
        wr_session_free(session);
        wr_text_fini(&line);
    }
}

/* ---- presets ---- */

static void assert_material(const WrMaterial *have, const WrMaterial *want, const char *what)
{
    if (have->model != want->model || have->energy != want->energy || have->gate != want->gate ||
        memcmp(&have->colour, &want->colour, sizeof have->colour) != 0)
        fail_msg("%s: another model or colour", what);
    assert_true(have->ambient == want->ambient && have->diffuse == want->diffuse);
    assert_true(have->specular == want->specular && have->shininess == want->shininess);
    assert_true(have->roughness == want->roughness && have->metalness == want->metalness);
    assert_true(have->ior == want->ior && have->tint == want->tint);
}

/* Each preset replaces all values of another material, is restored from its lines, and comes before other arguments;
   no white surface with it reflects more than it receives. */
static void a_preset_is_a_whole_material(void **state)
{
    (void)state;
    const char *const other[] = { "material model=phong tint=0.7 gate=off ior=2.5 ambient=0.9 "
                                  "metalness=0.25 energy=published colour=0.1,0.2,0.3",
                                  NULL };
    for (int i = 0; i < WR_MATERIAL_PRESETS; i++) {
        const WrMaterialPreset *preset = &wr_material_presets[i];
        WrText line = { 0 };
        WrSession *session = session_of(other);
        wr_text_addf(&line, "material preset=%s", preset->name);
        must_run(session, wr_text_get(&line));
        assert_material(&doc(session)->scene->material, &preset->material, preset->name);
        WrSession *again = restored(doc(session)->scene);
        assert_material(&doc(again)->scene->material, &preset->material, preset->name);
        wr_text_add(&line, " roughness=0.71");
        must_run(session, wr_text_get(&line));
        assert_true(doc(session)->scene->material.roughness == 0.71);
        assert_true(preset->material.energy == WR_ENERGY_KEPT);
        for (int c = 0; c < 3; c++) {
            const double colour = (&preset->material.colour.x)[c];
            assert_true(colour >= 0 && colour <= 1);
        }
        wr_session_free(again);
        wr_session_free(session);
        wr_text_fini(&line);
    }
    WrSession *session = session_of(other);
    must_fail(session, "material preset=goldd", "must be one of usual, clay");
    wr_session_free(session);
}

/* ---- the plan ---- */

static WrPlan plan_of(WrRenderer *renderer, const WrField *field, const WrScene *scene)
{
    WrFrame frame;
    WrError err = { "" };
    WrFrameRequest request = { .field = field, .scene = scene, .width = 24, .height = 20 };
    if (!wr_renderer_frame(renderer, &request, &frame, &err)) fail_msg("%s", err.text);
    return *frame.plan;
}

/* Every row with every kind of value over all sorts of scenes: it changes a plan if, and only if, the row is marked so. */
static void the_plan_looks_at_what_says_so_and_at_nothing_else(void **state)
{
    static const char *const scenes[][4] = {
        { "surface sphere" },
        { "surface torus R=1 r=0.35", "dials aa=moments" },
        { "surface sphere R=1", "camera perspective eye=0.2,0.1,0.4 target=0,0,1",
          "bump mode=exact" },
        { "light point at=1,2,3 strength=0.5", "camera orthographic", "dials aa=filter" },
        { "surface cylinder", "material diffuse=0 specular=0.2", "dials aa=adaptive refine=bound" },
        { "surface sphere", "material model=oren-nayar roughness=0.4" },
        { "surface sphere", "material model=ggx metalness=0.5" },
        { "surface sphere", "material model=torrance-sparrow ior=1.6" },
        { "surface plane", "replicate 3,2", "bump mode=invariant scheme=nearest" },
        { "surface sphere", "material model=oren-nayar" },
        { "surface sphere", "material model=ggx", "environment sky" },
        { "surface sphere", "material model=torrance-sparrow" },
        { "surface sphere", "grain wood dark=0,0,0" },
        { "surface sphere", "grain marble light=0,0,0" },
        { "surface sphere", "grain noise drives=bump height=0.01" },
    };
    static const double special[] = { 0, 1, 0.3, 2500, 1e-3 };
    bool seen[WR_SCENE_PARAM_COUNT] = { false };
    WrError err = { "" };
    WrRenderer *renderer = wr_renderer_new(NULL, NULL, &err);
    (void)state;
    for (int k = 0; k < WR_LENGTH(scenes); k++) {
        WrSession *session = session_of((const char *const[]){ "table 17x12", NULL });
        must_run(session, "noise gradient");
        for (int l = 0; l < 4 && scenes[k][l]; l++) must_run(session, scenes[k][l]);
        const WrField *field = wr_document_field(doc(session));
        const WrPlan before = plan_of(renderer, field, doc(session)->scene);
        for (int i = 0; i < WR_SCENE_PARAM_COUNT; i++)
            for (int s = 0; s < WR_LENGTH(special); s++) {
                const WrSceneParam *p = &wr_scene_params[i];
                double values[3] = { special[s], special[s], special[s] };
                if (p->components == 3 && special[s] != 0) values[1] *= -0.7, values[2] *= 0.9;
                if (p->components && (special[s] < p->low || special[s] > p->high)) continue;
                if (p->of_light && p->form &&
                    (strcmp(p->form, "point") == 0) !=
                        (doc(session)->scene->lights[0].kind == WR_LIGHT_POINT))
                    continue;
                WrScene *scene = wr_scene_clone(doc(session)->scene);
                WrPlacement unused;
                wr_scene_param_set(p, owner_of(p, scene), values);
                if (i == WR_SCENE_PARAM_ROTATE) scene->posed = true;
                if (wr_scene_place(scene, 0, 1, &unused, NULL)) {
                    const WrPlan after = plan_of(renderer, field, scene);
                    if (!wr_plan_same(&before, &after)) {
                        seen[i] = true;
                        if (!p->planned)
                            fail_msg("%s %s changes the plan of scene %d", p->command, p->name, k);
                    }
                }
                wr_scene_free(scene);
            }
        wr_session_free(session);
    }
    for (int i = 0; i < WR_SCENE_PARAM_COUNT; i++)
        if (wr_scene_params[i].planned && !seen[i])
            fail_msg("%s %s was never seen to change a plan", wr_scene_params[i].command,
                     wr_scene_params[i].name);
    wr_renderer_free(renderer);
}

/* A switch omitted in a line is off, also if it is a word. */
static void what_is_left_out_of_a_light_is_off(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(NULL);
    must_run(s, "light directional to=1,0.3,2");
    assert_false(doc(s)->scene->lights[0].shadow);
    must_run(s, "light point at=1,0.3,2 shadow=on index=1");
    assert_true(doc(s)->scene->lights[0].shadow);
    must_run(s, "light directional to=1,0.3,2 index=1");
    assert_false(doc(s)->scene->lights[0].shadow);
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_left_out_of_a_light_is_off),
        cmocka_unit_test(ranges_defaults_and_words_are_sound),
        cmocka_unit_test(each_is_set_by_its_command_and_printed_again),
        cmocka_unit_test(a_preset_is_a_whole_material),
        cmocka_unit_test(the_plan_looks_at_what_says_so_and_at_nothing_else),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
