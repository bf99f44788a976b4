/* The command `object`: changes, undo, and restoration by scripts and documents. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/pool.h"
#include "base/text.h"
#include "image/image.h"
#include "document/object_tables.h"
#include "render/frame/frame.h"
#include "scene/objects.h"

static const char *const three[] = { "table 70x33",
                                     "noise gradient cells=5 amplitude=0.7",
                                     "layer add marks",
                                     "dab 0.3,0.6 radius=9 strength=1.25",
                                     "object set name=ball",
                                     "surface sphere R=0.8",
                                     "bump mode=invariant height=0.037",
                                     "object add band at=-1.2,0.31,0.07 size=0.73 layer=marks",
                                     "surface ribbon",
                                     "replicate 2,3",
                                     "material diffuse=0.61 colour=0.2,0.9,0.4",
                                     "object copy box at=0.9,-0.6,0.4 turn=12.5,-40,7 layer=all",
                                     "surface cube s=0.9",
                                     "analytic poly c=1,2,0.3",
                                     "light directional to=1,2,3",
                                     "camera orthographic eye=0.3,0.4,5 size=4",
                                     NULL };

static const WrScene *scene_of(const WrSession *session)
{
    return doc(session)->scene;
}

static const WrScene *object_of(const WrSession *session, const char *name)
{
    const int i = wr_scene_object_find(scene_of(session), name);
    assert_in_range(i, 0, 9);
    return wr_scene_object(scene_of(session), i);
}

static void commands_are_about_the_chosen_one(void **state)
{
    (void)state;
    WrSession *session = session_of(three);
    assert_int_equal(wr_scene_object_count(scene_of(session)), 3);
    const WrScene *ball = object_of(session, "ball"), *band = object_of(session, "band"),
                  *box = object_of(session, "box");
    assert_int_equal(ball->shape.kind, WR_SURFACE_sphere);
    assert_int_equal(ball->bump, WR_BUMP_INVARIANT);
    assert_true(ball->replicate_u == 1 && ball->material.diffuse == 0.72 && ball->size == 1);
    assert_int_equal(band->shape.kind, WR_SURFACE_ribbon);
    assert_int_equal(band->bump, WR_BUMP_BLINN); /* a new one starts as in an empty document */
    assert_true(band->replicate_v == 3 && band->at.x == -1.2 && band->size == 0.73);
    assert_string_equal(band->layer, "marks");
    /* a copy keeps all other settings of its original */
    assert_int_equal(box->shape.kind, WR_SURFACE_cube);
    assert_true(box->replicate_v == 3 && box->material.diffuse == 0.61 && box->size == 0.73);
    assert_true(box->posed && box->rotate_deg.y == -40 && !box->layer);
    assert_int_equal(band->analytic.kind, WR_ANALYTIC_OFF);
    must_run(session, "object choose band");
    must_run(session, "material diffuse=0.5");
    assert_true(object_of(session, "band")->material.diffuse == 0.5);
    assert_true(object_of(session, "box")->material.diffuse == 0.61);
    must_run(session, "object set hidden=on name=strip");
    assert_true(object_of(session, "strip")->hidden);
    must_run(session, "object hide box");
    assert_true(object_of(session, "box")->hidden && !object_of(session, "ball")->hidden);
    must_run(session, "object show");
    must_run(session, "object show box");
    assert_false(object_of(session, "box")->hidden || object_of(session, "strip")->hidden);
    assert_int_equal(wr_scene_object_find(scene_of(session), "band"), -1);
    must_run(session, "object remove ball");
    assert_int_equal(wr_scene_object_count(scene_of(session)), 2);
    assert_true(scene_of(session)->material.diffuse == 0.5); /* still active */
    must_run(session, "object remove");
    assert_int_equal(wr_scene_object_count(scene_of(session)), 1);
    assert_true(scene_of(session)->material.diffuse == 0.61);
    wr_session_free(session);
}

/* With several objects it is the same edit as turn=, under that name; undo reverts it. */
static void rotate_turns_the_chosen_one(void **state)
{
    (void)state;
    WrSession *session = session_of(three), *other = session_of(three);
    must_run(session, "object choose band"), must_run(other, "object choose band");
    const WrHash before = wr_session_hash(session);
    must_run(session, "rotate 12.375,-71,0.1");
    must_run(other, "object set turn=12.375,-71,0.1");
    assert_true(wr_hash_equal(wr_session_hash(session), wr_session_hash(other)));
    assert_false(wr_hash_equal(wr_session_hash(session), before));
    assert_string_equal(wr_session_last_command(session), wr_session_last_command(other));
    must_run(session, "undo");
    assert_true(wr_hash_equal(wr_session_hash(session), before));
    must_run(session, "redo");
    must_run(session, "rotate pose=own");
    assert_false(scene_of(session)->posed);
    wr_session_free(session);
    wr_session_free(other);
}

static void expect_heights(const char *path, const WrField *want)
{
    WrError err = { "" };
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    for (int j = 0; j < image->height; j++)
        for (int i = 0; i < image->width; i++)
            assert_true(image->data[j * image->width + i] == wr_field_get(want, i, j));
    wr_image_free(image);
}

/* The table of each object: its own layer, else the composite. */
static void exports_take_the_table_of_an_object(void **state)
{
    (void)state;
    static const char *const lines[] = { "table 23x14",
                                         "noise perlin cells=3",
                                         "layer rename 1 first",
                                         "layer add second",
                                         "noise value cells=5",
                                         "object set name=left layer=first",
                                         "object add right layer=second",
                                         "object add both",
                                         "export height left.exr object=left",
                                         "export height right.exr object=right",
                                         "export height both.exr object=both",
                                         "export height all.exr",
                                         "export lines left.svg object=left",
                                         "export profile right.svg object=right" };
    const WrSessionOptions options = { .outputs = true };
    WrSession *session = wr_session_new(&options);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) must_run(session, lines[i]);
    const WrDocument *document = wr_session_document(session);
    expect_heights("left.exr", document->layers[0].heights);
    expect_heights("right.exr", document->layers[1].heights);
    expect_heights("both.exr", wr_document_field(document));
    expect_heights("all.exr", wr_document_field(document));
    must_fail(session, "export normal+y none.png object=middle", "object 'middle'");
    must_run(session, "object choose left");
    must_run(session, "analytic poly c=1,2,0.3");
    must_run(session, "export height poly.exr object=left");
    WrImage *poly = wr_image_read("poly.exr", NULL);
    assert_non_null(poly);
    assert_true(poly->data[0] != wr_field_get(document->layers[0].heights, 0, 0));
    wr_image_free(poly);
    must_run(session, "object choose right");
    must_run(session, "export height right.exr object=right");
    expect_heights("right.exr", document->layers[1].heights);
    wr_session_free(session);
}

static void what_cannot_be_is_told(void **state)
{
    (void)state;
    WrSession *session = session_of(three);
    must_fail(session, "object add ball", "already");
    must_fail(session, "object choose bell", "from \"ball\" to \"box\"");
    must_fail(session, "object set name=band", "already");
    must_fail(session, "object set layer=none", "none");
    must_fail(session, "object set size=0", "size");
    must_fail(session, "object set at=1,2", "at");
    must_fail(session, "object set turn=1,2", "own");
    must_fail(session, "object add", "NAME");
    must_fail(session, "rotate", "give x,y,z or pose=own");
    must_run(session, "object remove box");
    must_run(session, "object remove band");
    must_fail(session, "object remove", "at least one");
    must_fail(session, "object set turn=1,2,3", "rotate");
    must_fail(session, "object choose box", "only one");
    must_run(session, "rotate 1,2,3");
    char line[64];
    for (int i = 1; i < WR_OBJECTS_MAX; i++) {
        snprintf(line, sizeof line, "object add n%d", i);
        must_run(session, line);
    }
    must_fail(session, "object copy more", "at most 64");
    wr_session_free(session);
}

static void each_can_be_undone(void **state)
{
    (void)state;
    WrSession *session = session_of(three);
    WrHash hash[32];
    int count = 0;
    while (wr_session_history_position(session) > 0) {
        hash[count++] = wr_session_hash(session);
        must_run(session, "undo");
    }
    assert_int_equal(wr_scene_object_count(scene_of(session)), 1);
    while (count > 0) {
        must_run(session, "redo");
        assert_true(wr_hash_equal(wr_session_hash(session), hash[--count]));
    }
    wr_session_free(session);
}

static void draw(WrSession *session, float *out)
{
    WrFrame frame;
    WrError err = { "" };
    if (!wr_session_frame(session, 60, 40, 20, &frame, &err)) fail_msg("%s", err.text);
    memcpy(out, frame.rgba, 60 * 40 * 4 * sizeof *out);
}

/* By its lines, by a document, and by an OpenRaster file: the same hash and picture. */
static void files_bring_them_back(void **state)
{
    (void)state;
    WrError err = { "" };
    static const char *const names[] = { "set.exr", "set.ora", "set.wrinkle" };
    WrSession *session = session_of(three);
    float before[60 * 40 * 4], after[60 * 40 * 4];
    uint8_t rgb[2][5 * 3 * 3];
    for (int i = 0; i < 2; i++) {
        char line[64], path[32];
        for (int k = 0; k < 45; k++) rgb[i][k] = (uint8_t)(37 * k + 91 * i);
        snprintf(path, sizeof path, "c%d.png", i);
        if (!wr_image_write_pixels(path, 5, 3, 3, WR_PIXEL_U8, false, rgb[i], &err))
            fail_msg("%s", err.text);
        must_run(session, i ? "object choose box" : "object choose band");
        snprintf(line, sizeof line, "colour %s", path);
        must_run(session, line);
    }
    must_run(session, "object choose band"); /* not the last one */
    draw(session, before);
    for (int i = 0; i < 3; i++) {
        char path[300];
        snprintf(path, sizeof path, "./%s", names[i]);
        const bool good = i < 2 ? wr_session_save(session, path, &err)
                                : wr_session_save_history(session, path, &err);
        if (!good) fail_msg("%s", err.text);
        WrSession *other = wr_session_new(NULL);
        if (!wr_session_open(other, path, &err)) fail_msg("%s", err.text);
        assert_true(wr_hash_equal(wr_session_hash(session), wr_session_hash(other)));
        assert_int_equal(scene_of(other)->chosen, 1);
        draw(other, after);
        assert_memory_equal(before, after, sizeof before);
        WrText a = { 0 }, b = { 0 };
        wr_session_scene_text(session, &a);
        wr_session_scene_text(other, &b);
        assert_string_equal(wr_text_get(&a), wr_text_get(&b));
        wr_text_fini(&a);
        wr_text_fini(&b);
        wr_session_free(other);
    }
    wr_session_free(session);
}

/* Memory of a history step: a picture counts if no object of the other state has it. */
static void pictures_count_once_whichever_object_is_at_hand(void **state)
{
    (void)state;
    WrError err = { "" };
    uint8_t rgb[40 * 30 * 3] = { 9 };
    const size_t bytes = 40 * 30 * 3 * sizeof(float);
    WrSession *session = session_of(three);
    if (!wr_image_write_pixels("large.png", 40, 30, 3, WR_PIXEL_U8, false, rgb, &err))
        fail_msg("%s", err.text);
    must_run(session, "object choose band");
    must_run(session, "colour large.png");
    const int last = wr_session_history_count(session) - 1;
    assert_in_range(wr_session_history_step_bytes(session, last), bytes, 3 * bytes);
    must_run(session, "object choose box");
    assert_in_range(wr_session_history_step_bytes(session, last + 1), 0, bytes - 1);
    must_run(session, "object remove band");
    assert_in_range(wr_session_history_step_bytes(session, last + 2), bytes, 3 * bytes);
    wr_session_free(session);
}

/* The layer of one object is displayed alone, as if the document had no other. */
static void a_layer_of_its_own_shows_alone(void **state)
{
    (void)state;
    float own[60 * 40 * 4], alone[60 * 40 * 4];
    WrSession *session = session_of(three);
    must_run(session, "object remove ball");
    must_run(session, "object remove box");
    must_run(session, "layer set marks opacity=0.4");
    draw(session, own);
    must_run(session, "layer set 1 visible=off");
    must_run(session, "object set layer=all");
    draw(session, alone);
    assert_memory_equal(own, alone, sizeof own);
    must_run(session, "undo");
    must_run(session, "layer rename marks strokes"); /* it stays the table under its new name */
    draw(session, alone);
    assert_memory_equal(own, alone, sizeof own);
    assert_string_equal(scene_of(session)->layer, "strokes");
    /* it is deleted: the composite is used, without a failure */
    must_run(session, "layer delete strokes");
    must_run(session, "layer set 1 visible=on");
    draw(session, own);
    assert_memory_not_equal(own, alone, sizeof own);
    wr_session_free(session);
}

/* Covered pixels of a picture, as a copy of all of it. */
static float *picture_of(WrSession *session, int64_t *covered)
{
    WrFrame frame;
    WrError err;
    if (!wr_session_frame(session, 60, 40, 0, &frame, &err)) fail_msg("%s", err.text);
    const size_t count = 60 * 40 * 4;
    float *copy = malloc(count * sizeof *copy);
    memcpy(copy, frame.rgba, count * sizeof *copy);
    *covered = frame.covered;
    return copy;
}

static void a_floor_is_seen_from_above_only(void **state)
{
    (void)state;
    static const char *const cameras[][2] = {
        { "camera perspective eye=0,-2,5 target=0,0,0",
          "camera perspective eye=0,2,5 target=0,0,0" },
        { "camera orthographic eye=0,-2,5 target=0,0,0 size=4",
          "camera orthographic eye=0,2,5 target=0,0,0 size=4" }
    };
    for (int k = 0; k < 2; k++) {
        WrSession *with = session_of((const char *[]){ "surface sphere", "ground on", NULL });
        WrSession *without = session_of(
            (const char *[]){ "surface sphere", "ground on", "object hide ground", NULL });
        int64_t all, ball;
        must_run(with, cameras[k][0]);
        must_run(without, cameras[k][0]);
        float *a = picture_of(with, &all), *b = picture_of(without, &ball);
        assert_true(ball > 100);
        assert_memory_equal(a, b, 60 * 40 * 4 * sizeof *a);
        free(a);
        must_run(with, cameras[k][1]);
        a = picture_of(with, &all);
        assert_true(all > ball + 400);
        free(a);
        free(b);
        must_run(with, "object choose ground"); /* one that turns with the others is not a floor */
        must_run(with, "object set still=off");
        must_run(with, cameras[k][0]);
        a = picture_of(with, &all);
        assert_true(all > ball + 400);
        free(a);
        wr_session_free(with);
        wr_session_free(without);
    }
}

static int64_t pieces_of_frame(WrSession *session)
{
    WrFrame frame;
    const int64_t before = wr_pool_pieces();
    assert_true(wr_session_frame(session, 61, 47, 0, &frame, NULL));
    return wr_pool_pieces() - before;
}

/* After an edit of a layer that no object uses, a picture needs no more work than without an edit: nothing is blended. */
static void layers_that_no_object_uses_cost_nothing(void **state)
{
    (void)state;
    static const char *const lines[] = { "table 130x90",    "noise gradient cells=5 amplitude=0.7",
                                         "layer add other", "noise gradient cells=7",
                                         "surface sphere",  NULL };
    WrSession *session = session_of(lines);
    for (int own = 0; own < 2; own++) {
        if (own) must_run(session, "object set layer=1");
        pieces_of_frame(session);
        const int64_t again = pieces_of_frame(session);
        must_run(session, "layer use 2");
        must_run(session, "adjust invert");
        const int64_t edited = pieces_of_frame(session);
        if (own) assert_int_equal(edited, again);
        else assert_true(edited > again);
    }
    wr_session_free(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(commands_are_about_the_chosen_one),
        cmocka_unit_test(exports_take_the_table_of_an_object),
        cmocka_unit_test(rotate_turns_the_chosen_one),
        cmocka_unit_test(what_cannot_be_is_told),
        cmocka_unit_test(each_can_be_undone),
        cmocka_unit_test(files_bring_them_back),
        cmocka_unit_test(pictures_count_once_whichever_object_is_at_hand),
        cmocka_unit_test(a_layer_of_its_own_shows_alone),
        cmocka_unit_test(layers_that_no_object_uses_cost_nothing),
        cmocka_unit_test(a_floor_is_seen_from_above_only),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
