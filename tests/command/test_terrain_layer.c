/* `surface terrain layer=`: a terrain from a layer's heights, coloured by height. After any edits, picture, form and
   hash equal those of a new session with the same document; the form is not also a bump. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/memory.h"
#include "brush/brush.h"
#include "render/frame/frame.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#include <unistd.h>

#define SIDE 44

static const WrScene *scene_in(const WrSession *session)
{
    return doc(session)->scene;
}

static WrSession *ground(void)
{
    return session_of((const char *const[]){
        "table 50x38", "layer add hill", "dab 0.3,0.6 radius=14 strength=0.7", "layer add fine",
        "noise perlin cells=6 amplitude=0.4",
        "surface terrain layer=hill cells=5 height=0.35 b=0.8", "bump scheme=bspline height=0.03",
        "colouring ramp steep=0.3,0.2,0.1", NULL });
}

static float *picture_of(WrSession *session)
{
    WrFrame frame;
    WrError err = { "" };
    if (!wr_session_frame(session, SIDE, SIDE, 20, &frame, &err)) fail_msg("%s", err.text);
    float *copy = wr_alloc(SIDE * SIDE * 4, sizeof *copy);
    memcpy(copy, frame.rgba, SIDE * SIDE * 4 * sizeof *copy);
    return copy;
}

/* The session's picture, from a renderer with history, compared with that of a new session that opens its
   document. */
static void assert_as_anew(WrSession *session, const char *what)
{
    WrError err = { "" };
    WrSession *other = wr_session_new(NULL);
    if (!wr_session_save(session, "d.exr", &err) || !wr_session_open(other, "d.exr", &err))
        fail_msg("%s: %s", what, err.text);
    float *a = picture_of(session), *b = picture_of(other);
    if (memcmp(a, b, SIDE * SIDE * 4 * sizeof *a) != 0) fail_msg("%s: another picture", what);
    assert_true(scene_in(session)->triangles->key == scene_in(other)->triangles->key);
    assert_true(wr_hash_equal(wr_session_hash(session), wr_session_hash(other)));
    wr_free(b);
    wr_free(a);
    wr_session_free(other);
}

static void random_stroke(WrSession *session, TestRandom *random, bool kept)
{
    WrSample samples[3];
    WrError err = { "" };
    for (int i = 0; i < 3; i++)
        samples[i] = (WrSample){ .u = test_random(random),
                                 .v = test_random(random),
                                 .pressure = 0.3 + 0.7 * test_random(random),
                                 .seconds = i };
    if (!wr_session_stroke_begin(session, "stroke radius=7 strength=0.4", &err) ||
        !wr_session_stroke_add(session, samples, 3, &err))
        fail_msg("%s", err.text);
    if (kept) assert_true(wr_session_stroke_end(session, &err));
    else wr_session_stroke_cancel(session);
}

/* One edit, of the form's layer in half of the cases. */
static void random_edit(WrSession *session, TestRandom *random)
{
    char line[120];
    const int what = (int)(11 * test_random(random));
    const double u = test_random(random), v = test_random(random);
    const int steps = wr_session_history_position(session) - wr_session_history_oldest(session);
    switch (what) {
    case 0:
    case 1: random_stroke(session, random, what == 0); return;
    case 2: must_run(session, "layer use hill"); return;
    case 3: must_run(session, "layer use fine"); return;
    case 4: snprintf(line, sizeof line, "layer set hill opacity=%.3f", 0.2 + 0.8 * u); break;
    case 5: snprintf(line, sizeof line, "adjust multiply factor=%.3f", 0.6 + u); break;
    case 6: snprintf(line, sizeof line, "camera orbit %.2f,%.2f", 40 * u - 20, 30 * v - 15); break;
    case 7: snprintf(line, sizeof line, "undo"); break;
    case 8: snprintf(line, sizeof line, "redo"); break;
    case 9: snprintf(line, sizeof line, "bump height=%.4f", 0.05 * u); break;
    default: snprintf(line, sizeof line, "dab %.4f,%.4f radius=%.2f strength=0.5", u, v, 3 + 9 * v);
    }
    if (what == 7 && steps < 3) return;
    WrError err;
    if (!wr_session_run(session, line, &err) && what != 8) fail_msg("%s: %s", line, err.text);
}

static void edits_reshape_the_ground_to_the_bits_of_a_new_one(void **state)
{
    (void)state;
    TestRandom random = { 21 };
    WrSession *session = ground();
    uint64_t key = scene_in(session)->triangles->key;
    int forms = 0;
    for (int i = 0; i < 40; i++) {
        char what[32];
        snprintf(what, sizeof what, "edit %d", i);
        random_edit(session, &random);
        if (i % 2) assert_as_anew(session, what);
        else wr_free(picture_of(session));
        forms += scene_in(session)->triangles->key != key;
        key = scene_in(session)->triangles->key;
    }
    assert_in_range(forms, 8, 32); /* only edits of the layer rebuild the form */
    wr_session_free(session);
}

/* The form of a layer equals that of its exported picture. */
static void a_layer_has_the_form_of_its_picture(void **state)
{
    (void)state;
    WrSession *a = session_of((const char *const[]){
        "table 61x43", "noise perlin cells=5 octaves=3 seed=9",
        "surface terrain layer=1 cells=9 height=0.3", "layer set 1 visible=on", NULL });
    WrSession *b = wr_session_new(&(WrSessionOptions){ .outputs = true });
    WrError err = { "" };
    must_run(b, "table 61x43");
    must_run(b, "noise perlin cells=5 octaves=3 seed=9");
    must_run(b, "export height h.exr");
    must_run(b, "surface terrain file=h.exr cells=9 height=0.3");
    assert_true(scene_in(a)->triangles->key == scene_in(b)->triangles->key);
    must_run(a, "adjust multiply factor=1.5"); /* so that it is twice as high as a second one */
    must_run(b, "surface terrain file=h.exr cells=9 height=0.45");
    assert_near(scene_in(a)->triangles->radius, scene_in(b)->triangles->radius, 1e-6);
    if (!wr_session_open(b, "h.exr", &err)) fail_msg("%s", err.text);
    wr_session_free(b);
    wr_session_free(a);
}

static bool is_visible(const WrSession *session, int layer)
{
    return doc(session)->layers[layer].visible;
}

static void form_and_bump_are_two_layers(void **state)
{
    (void)state;
    Said said = { "" };
    const WrSessionOptions options = { .note = hear_note, .note_ctx = &said };
    WrSession *s = wr_session_new(&options);
    must_run(s, "table 20x20");
    must_run(s, "layer add hill");
    must_run(s, "dab 0.5,0.5 radius=8 strength=1");
    const float top = f_at(s, 10, 10);
    assert_true(top > 0.5f);
    must_run(s, "surface terrain layer=hill cells=4");
    assert_non_null(strstr(said.text, "layer 2 was hidden"));
    assert_false(is_visible(s, 1));
    assert_true(f_at(s, 10, 10) == 0);              /* no longer a bump */
    must_run(s, "dab 0.5,0.5 radius=5 strength=1"); /* though hidden, it can be painted */
    must_run(s, "layer set hill visible=on");       /* both, on request */
    must_run(s, "surface terrain layer=hill cells=5");
    assert_true(is_visible(s, 1));
    must_run(s, "layer rename hill mound");
    assert_string_equal(scene_in(s)->form_layer, "mound");
    const uint64_t key = scene_in(s)->triangles->key;
    must_run(s, "layer delete mound"); /* the form stays */
    assert_true(scene_in(s)->triangles->key == key);
    must_run(s, "undo 6");
    assert_true(is_visible(s, 1));
    assert_null(scene_in(s)->triangles);
    assert_true(f_at(s, 10, 10) == top);
    must_run(s, "object set layer=hill");
    must_fail(s, "surface terrain layer=hill", "choose another for the terrain");
    must_fail(s, "surface terrain layer=valley", "no layer is called");
    must_fail(s, "surface terrain layer=hill file=h.png", "not both");
    wr_session_free(s);
}

/* Two objects with two forms, one of them not active. */
static void each_object_has_its_own_form(void **state)
{
    (void)state;
    WrSession *s = ground();
    must_run(s, "object copy second at=1.5,0,0");
    must_run(s, "surface terrain layer=base cells=4");
    must_run(s, "colouring ramp of=table");
    must_run(s, "layer use hill");
    const uint64_t own = scene_in(s)->triangles->key,
                   first = wr_scene_object(scene_in(s), 0)->triangles->key;
    must_run(s, "dab 0.6,0.3 radius=9 strength=0.5");
    assert_true(scene_in(s)->triangles->key == own);
    assert_true(wr_scene_object(scene_in(s), 0)->triangles->key != first);
    assert_as_anew(s, "two objects");
    must_run(s, "layer use fine");
    must_run(s, "dab 0.3,0.7 radius=9 strength=0.7");
    assert_as_anew(s, "two objects' colours");
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edits_reshape_the_ground_to_the_bits_of_a_new_one),
        cmocka_unit_test(a_layer_has_the_form_of_its_picture),
        cmocka_unit_test(form_and_bump_are_two_layers),
        cmocka_unit_test(each_object_has_its_own_form),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
