/* The command `bake`: heights as a layer in the table's unit, normals and colours as pictures of the object, replay, undo,
   documents, and errors. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "image/image.h"
#include "scene/scene.h"

static void write_text(const char *path, const char *text)
{
    WrError err;
    if (!wr_file_write(path, text, strlen(text), &err)) fail_msg("%s", err.text);
}

static const char low[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                          "f 1/1 2/2 3/3 4/4\n";

/* z = 0.1 x + 0.05 y + rise, from x = -1 on to `right`, in squares of 1/4. */
static void write_high(const char *path, double rise, double right)
{
    WrText text = { 0 };
    const int across = (int)(4 * (right + 1)), down = 12;
    for (int j = 0; j <= down; j++)
        for (int i = 0; i <= across; i++) {
            const double x = i / 4.0 - 1, y = j / 4.0 - 1;
            wr_text_addf(&text, "v %.9g %.9g %.9g\n", x, y, 0.1 * x + 0.05 * y + rise);
        }
    for (int j = 0; j < down; j++)
        for (int i = 0; i < across; i++) {
            const int p = j * (across + 1) + i + 1;
            wr_text_addf(&text, "f %d %d %d %d\n", p, p + 1, p + across + 2, p + across + 1);
        }
    write_text(path, wr_text_get(&text));
    wr_text_fini(&text);
}

static WrSession *with_low(Said *said)
{
    write_text("low.obj", low);
    WrSession *s = listening(said);
    must_run(s, "table 48x36");
    must_run(s, "surface mesh file=low.obj");
    return s;
}

static void heights_become_a_layer_in_the_tables_unit(void **state)
{
    (void)state;
    Said said;
    write_high("high.obj", 0.02, 2);
    WrSession *s = with_low(&said);
    must_run(s, "bump height=-0.5");
    must_run(s, "bake high.obj");
    assert_int_equal(doc(s)->layer_count, 2);
    assert_int_equal(doc(s)->active, 1);
    assert_non_null(strstr(said.text, "high.obj: height baked into 48x36"));
    assert_non_null(strstr(said.text, "1728 texels, none missed"));
    assert_null(strstr(said.text, "the cage exceeds"));
    for (int j = 0; j < 36; j++)
        for (int i = 0; i < 48; i++) {
            const double u = (i + 0.5) / 48, v = 1 - (j + 0.5) / 36;
            assert_near((double)f_at(s, i, j), (0.1 * u + 0.05 * v + 0.02) / -0.5, 1e-6);
        }
    const WrHash baked = wr_session_hash(s);
    must_run(s, "undo");
    assert_int_equal(doc(s)->layer_count, 1);
    must_run(s, "redo");
    assert_true(wr_hash_equal(wr_session_hash(s), baked));
    WrSession *again = with_low(&said);
    must_run(again, "bump height=-0.5");
    must_run(again, "bake high.obj map=height cage=auto");
    assert_true(wr_hash_equal(wr_session_hash(again), baked));
    write_high("high.obj", 0.03, 2);
    must_run(s, "undo");
    must_run(s, "bake high.obj");
    assert_false(wr_hash_equal(wr_session_hash(s), baked));
    wr_session_free(again);
    wr_session_free(s);
}

/* Both meshes far from their file's origin, moved by whole numbers so that the floats are the same: the same table. The mesh
   that is baked begins elsewhere, so that it is moved by other numbers than the object's. */
static void far_meshes_bake_as_near_ones(void **state)
{
    (void)state;
    Said said;
    WrHash hash[2];
    for (int k = 0; k < 2; k++) {
        const double far[3] = { 30000 * k, -70000 * k, 50000 * k };
        WrText text = { 0 };
        for (int i = 0; i < 4; i++)
            wr_text_addf(&text, "v %.9g %.9g %.9g\n", far[0] + (i == 1 || i == 2),
                         far[1] + (i >= 2), far[2]);
        wr_text_add(&text, strstr(low, "vt 0 0"));
        write_text("low.obj", wr_text_get(&text));
        wr_text_clear(&text);
        for (int i = 0; i < 25;
             i++) { /* squares of side 1, from -2,-1 on, on the hills of a parabola */
            const int x = i % 5 - 2, y = i / 5 - 1;
            wr_text_addf(&text, "v %.9g %.9g %.9g\n", far[0] + x, far[1] + y,
                         far[2] + (x * x + 2 * y) / 16.0);
        }
        for (int i = 0; i < 20; i++)
            if (i % 5 < 4)
                wr_text_addf(&text, "f %d %d %d\nf %d %d %d\n", i + 1, i + 2, i + 7, i + 1, i + 7,
                             i + 6);
        write_text("high.obj", wr_text_get(&text));
        wr_text_fini(&text);
        WrSession *s = listening(&said);
        must_run(s, "table 48x36");
        must_run(s, "surface mesh file=low.obj");
        must_run(s, "bake high.obj cage=1");
        assert_non_null(strstr(said.text, "none missed"));
        hash[k] = wr_field_hash(doc(s)->layers[1].heights);
        wr_session_free(s);
    }
    assert_true(wr_hash_equal(hash[0], hash[1]));
}

static void misses_are_noted_and_padded(void **state)
{
    (void)state;
    Said said;
    write_high("half.obj", 0, 0.5);
    WrSession *s = with_low(&said);
    must_run(s, "bump height=1");
    must_run(s, "bake half.obj padding=3 cage=1");
    assert_non_null(
        strstr(said.text, "1728 texels, 864 of which missed it (0 hit only back faces)"));
    assert_near((double)f_at(s, 26, 20), (double)f_at(s, 23, 20), 0.01);
    assert_near((double)f_at(s, 27, 20), 0, 0); /* beyond; u wraps round at the other side */
    assert_true(f_at(s, 45, 20) > 0);
    assert_null(strstr(said.text, "the cage exceeds"));
    must_run(s, "undo");
    must_run(s, "bake half.obj"); /* which begins 1.4 from the square, whose radius is 0.71 */
    assert_non_null(strstr(said.text, "the cage exceeds the object's radius"));
    wr_session_free(s);
}

/* A step of 45 degrees without normals: with crease= each side bakes its own normal, without it the edge is rounded. */
static void a_crease_of_the_detailed_mesh_stays_sharp(void **state)
{
    (void)state;
    static const char bent[] =
        "v -1 -1 0.5\nv 0.5 -1 0.5\nv 0.5 2 0.5\nv -1 2 0.5\nv 2 -1 -1\nv 2 2 -1\n"
        "f 1 2 3 4\nf 2 5 6 3\n";
    Said said;
    write_text("bent.obj", bent);
    WrSession *s = with_low(&said);
    for (int k = 0; k < 2; k++) {
        must_run(s, k ? "bake bent.obj map=object-normal crease=30 cage=3"
                      : "bake bent.obj map=object-normal cage=3");
        const WrImage *map = doc(s)->scene->normals.image;
        const float *left = map->data + 3 * (20 * (size_t)map->width + 20); /* u = 0.43 */
        const float *right = map->data + 3 * (20 * (size_t)map->width + 27);
        if (k == 1) assert_near((double)left[2], 1, 1e-6);
        if (k == 1) assert_near((double)right[2], sqrt(0.5), 1e-6);
        if (k == 0) assert_true(left[2] < 0.99f && right[2] > 0.72f);
    }
    wr_session_free(s);
}

/* Two faces of the object share their texels: said with the share and the first place. */
static void shared_texels_are_noted(void **state)
{
    (void)state;
    Said said;
    write_high("high.obj", 0.02, 2);
    WrSession *s = with_low(&said);
    write_text("twice.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                            "f 1/1 2/2 3/3\nf 1/1 3/2 4/3\n");
    must_run(s, "bake high.obj map=position");
    assert_null(strstr(said.text, "overlap"));
    must_run(s, "surface mesh file=twice.obj");
    said.text[0] = '\0';
    must_run(s, "bake high.obj map=position");
    assert_non_null(
        strstr(said.text, "100.0% of the object's texture coordinates overlap, first at u, v of "));
    wr_session_free(s);
}

static void normals_are_the_objects_map(void **state)
{
    (void)state;
    Said said;
    const double length = sqrt(0.1 * 0.1 + 0.05 * 0.05 + 1);
    write_high("high.obj", 0, 2);
    WrSession *s = with_low(&said);
    must_run(s, "bake high.obj map=normal size=24x20 samples=2");
    const WrHash baked = wr_session_hash(s);
    const WrNormalMap *map = &doc(s)->scene->normals;
    assert_int_equal(map->image->width, 24);
    assert_int_equal(map->frame, WR_FRAME_MIKK);
    assert_int_equal(map->combine, WR_COMBINE_REORIENTED);
    assert_int_equal(doc(s)->layer_count, 1);
    for (int i = 0; i < 24 * 20; i++) {
        const double want[3] = { -0.1 / length, -0.05 / length, 1 / length };
        for (int k = 0; k < 3; k++) assert_near((double)map->image->data[3 * i + k], want[k], 1e-6);
    }
    must_run(s, "save d.exr");
    must_run(s, "bake high.obj map=normal size=24x21 samples=2");
    assert_false(wr_hash_equal(wr_session_hash(s), baked));
    WrError err = { "" };
    remove("high.obj"); /* a document holds its pictures */
    if (!wr_session_open(s, "d.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(s), baked));
    map = &doc(s)->scene->normals;
    assert_near((double)map->image->data[0], -0.1 / length, 1e-6);
    assert_int_equal(map->frame, WR_FRAME_MIKK);
    assert_int_equal(map->combine, WR_COMBINE_REORIENTED);
    wr_session_free(s);
}

static void other_maps_are_colours_or_normals_of_the_object(void **state)
{
    (void)state;
    Said said;
    write_high("high.obj", 0, 2);
    WrSession *s = with_low(&said);
    must_run(s, "bake high.obj map=occlusion size=8x8");
    assert_int_equal(doc(s)->scene->colour->channels, 1);
    assert_near((double)doc(s)->scene->colour->data[0], 1, 0.05);
    must_run(s, "bake high.obj map=parts size=8x8");
    assert_int_equal(doc(s)->scene->colour->channels, 3);
    must_run(s, "bake high.obj map=object-normal size=8x8");
    assert_true(doc(s)->scene->normals.object);
    assert_non_null(doc(s)->scene->colour);
    wr_session_free(s);
}

typedef struct Stop {
    volatile int cancel;
    int reports, at;
} Stop;

static void count_report(void *ctx, double fraction)
{
    Stop *stop = ctx;
    assert_true(fraction >= 0 && fraction <= 1);
    if (++stop->reports == stop->at) stop->cancel = 1;
}

static void cancelled_it_changes_nothing(void **state)
{
    (void)state;
    Said said;
    write_high("high.obj", 0, 2);
    WrSession *s = with_low(&said);
    const WrHash before = wr_session_hash(s);
    bool good = false;
    int at = 0;
    while (!good) {
        WrError err = { "" };
        at += test_amount(1, 3);
        Stop stop = { .at = at };
        const WrProgress progress = { &stop.cancel, count_report, &stop };
        wr_progress_set(&progress);
        good = wr_session_run(s, "bake high.obj map=normal size=64x64 samples=3", &err);
        wr_progress_set(NULL);
        if (good) break;
        assert_non_null(strstr(err.text, "cancelled"));
        assert_true(wr_hash_equal(wr_session_hash(s), before));
    }
    assert_true(at > 20);
    wr_session_free(s);
}

static void errors_name_the_remedy(void **state)
{
    (void)state;
    Said said;
    write_high("high.obj", 0, 2);
    write_high("away.obj", 50, 2);
    WrSession *s = with_low(&said);
    must_fail(s, "bake none.obj", "none.obj");
    must_fail(s, "bake away.obj cage=1", "do both meshes have the same position and unit?");
    must_fail(s, "bake high.obj size=64x64", "of the table's size, 48x36");
    must_fail(s, "bake high.obj cage=-1", "must be auto, or a distance above 0");
    must_fail(s, "bake high.obj samples=9", "1..8");
    must_fail(s,
              "bake high.obj sha256="
              "0000000000000000000000000000000000000000000000000000000000000000",
              "file has changed");
    must_run(s, "bump height=0");
    must_fail(s, "bake high.obj", "bump height=0");
    must_run(s, "bump height=1");
    must_run(s, "replicate 2,2");
    must_fail(s, "bake high.obj", "`replicate 1,1`");
    must_run(s, "surface sphere");
    must_fail(s, "bake high.obj", "the object is a sphere");
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(heights_become_a_layer_in_the_tables_unit, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(far_meshes_bake_as_near_ones, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(misses_are_noted_and_padded, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(a_crease_of_the_detailed_mesh_stays_sharp, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(shared_texels_are_noted, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(normals_are_the_objects_map, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(other_maps_are_colours_or_normals_of_the_object,
                                        enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(cancelled_it_changes_nothing, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(errors_name_the_remedy, enter_own_folder, leave_own_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
