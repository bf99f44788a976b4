/* Surroundings of the objects: background, camera, floor, separate tables. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/text.h"
#include "document/object_tables.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/camera_control.h"
#include "scene/backface_range.h"
#include "scene/camera.h"
#include "scene/objects.h"
#include "scene/scene.h"

#include <string.h>

static const WrScene *scene_of(const WrSession *session)
{
    return doc(session)->scene;
}

static WrSession *renderer_of(size_t picture_bytes)
{
    const WrSessionOptions options = { .outputs = true, .picture_bytes = picture_bytes };
    WrSession *session = wr_session_new(&options);
    must_run(session, "surface sphere");
    return session;
}

static WrImage *rendered(WrSession *session, const char *name)
{
    WrText line = { 0 };
    WrError err;
    wr_text_addf(&line, "render %s size=96x160", name);
    must_run(session, wr_text_get(&line));
    wr_text_fini(&line);
    WrImage *image = wr_image_read(name, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

static void a_document_keeps_its_background(void **state)
{
    (void)state;
    static const char *const lines[][3] = {
        { "background none" },
        { "background plain colour=0.1,0.2,0.3" },
        { "background plain colour=0.1,0.2,0.3", "background none" },
        { "background gradient top=0.1,0.2,0.3" },
        { "background gradient bottom=0.1,0.2,0.3" },
        { "background gradient bottom=0.1,0.2,0.3", "background plain colour=0.5,0.5,2" },
        { "background gradient top=0.4,0,0 bottom=0.1,0.2,0.3", "background none" },
        { "background gradient", "background plain" },
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        WrSession *session = wr_session_new(&(WrSessionOptions){ .outputs = true });
        int steps = 0;
        for (; steps < 3 && lines[i][steps]; steps++) must_run(session, lines[i][steps]);
        must_run(session, "save kept.exr");
        WrSession *other = wr_session_new(NULL);
        must_run(other, "open kept.exr");
        const WrBackground *a = &scene_of(session)->background, *b = &scene_of(other)->background;
        assert_int_equal(a->kind, b->kind);
        assert_memory_equal(a->top, b->top, sizeof a->top);
        assert_memory_equal(a->bottom, b->bottom, sizeof a->bottom);
        must_run(session, steps == 1 ? "undo" : "undo 2");
        assert_int_equal(scene_of(session)->background.kind, WR_BACKGROUND_PLAIN);
        assert_true(scene_of(session)->background.top[0] == 0.032);
        wr_session_free(session);
        wr_session_free(other);
    }
}

/* The borders have the two colours, the codes between decrease evenly, and bands and tolerances make no
   difference. */
static void a_gradient_is_even_and_whole(void **state)
{
    (void)state;
    WrSession *session = renderer_of(0), *banded = renderer_of(4096);
    must_run(session, "background gradient top=0,0.5,1 bottom=1,0.5,0.25");
    must_run(banded, "background gradient top=0,0.5,1 bottom=1,0.5,0.25");
    WrImage *whole = rendered(session, "whole.png"), *bands = rendered(banded, "bands.png");
    const size_t pixels = (size_t)whole->width * (size_t)whole->height;
    assert_memory_equal(whole->data, bands->data, pixels * 3 * sizeof(float));
    wr_image_free(bands);
    must_run(banded, "tolerance max=1");
    bands = rendered(banded, "tolerant.png");
    for (int y = 0; y < whole->height; y++) {
        const float *left = whole->data + (size_t)(3 * y * whole->width);
        const double share = y / (whole->height - 1.0);
        assert_near(left[0], share, 0.51 / 255);
        assert_near(left[1], wr_srgb_encode(0.5f), 0.51 / 255);
        assert_near(left[2], 1 + share * ((double)wr_srgb_encode(0.25f) - 1), 0.51 / 255);
        assert_memory_equal(left, bands->data + (size_t)(3 * y * whole->width), 3 * sizeof(float));
    }
    wr_image_free(whole);
    wr_image_free(bands);
    wr_session_free(session);
    wr_session_free(banded);
}

/* The same in front of an environment, with tone mapping: bands, tolerances and float files too; documents store the
   settings. */
static void surroundings_stand_behind_and_light_is_developed(void **state)
{
    (void)state;
    static const char *const lines[] = { "background plain colour=0.4,0.3,0.2",
                                         "environment raking turn=71.5", "background surroundings",
                                         "tone soft exposure=-0.37" };
    WrSession *session = renderer_of(0), *banded = renderer_of(4096);
    for (int i = 0; i < 4; i++) must_run(session, lines[i]), must_run(banded, lines[i]);
    must_run(session, "material ambient=0.1");
    must_run(banded, "material ambient=0.1");
    WrImage *whole = rendered(session, "sky.png"), *bands = rendered(banded, "bands.png");
    const size_t size = (size_t)whole->width * (size_t)whole->height * 3 * sizeof(float);
    assert_memory_equal(whole->data, bands->data, size);
    wr_image_free(bands);
    must_run(banded, "tolerance max=1");
    wr_image_free(rendered(banded, "tolerant.png"));
    must_run(session, "save sky.ora");
    WrSession *other = renderer_of(0);
    must_run(other, "open sky.ora");
    bands = rendered(other, "again.png");
    assert_memory_equal(whole->data, bands->data, size);
    WrImage *light = rendered(session, "light.exr");
    must_run(session, "tone clip exposure=0");
    WrImage *same = rendered(session, "same.exr");
    assert_memory_equal(light->data, same->data, size / 3 * 4);
    int covered = 0;
    for (int i = 0; i < light->width * light->height; i++) {
        if (light->data[4 * i + 3] < 1) continue;
        for (int c = 0; c < 3; c++) {
            const double seen = (double)light->data[4 * i + c] * pow(2, -0.37);
            const double soft = seen > 0.5 ? 1 - 1 / (4 * seen) : seen;
            assert_near(whole->data[3 * i + c], wr_srgb_encode((float)soft), 0.52 / 255);
        }
        covered++;
    }
    assert_true(covered > 100);
    WrImage *all[] = { whole, bands, light, same };
    for (int i = 0; i < 4; i++) wr_image_free(all[i]);
    wr_session_free(session);
    wr_session_free(banded);
    wr_session_free(other);
}

/* Alpha is coverage, colours are not premultiplied, and edges are blended with the background. */
static void edges_stand_before_their_background(void **state)
{
    (void)state;
    WrSession *session = renderer_of(0);
    must_run(session, "dials aa=supersample samples=4");
    must_run(session, "background gradient top=0.9,0.1,0.1 bottom=0.1,0.1,0.9");
    WrImage *over = rendered(session, "over.png"), *light = rendered(session, "light.exr");
    must_run(session, "background none");
    WrImage *alone = rendered(session, "alone.png"), *jpeg = rendered(session, "alone.jpg");
    assert_int_equal(over->channels, 3);
    assert_int_equal(alone->channels, 4);
    assert_int_equal(jpeg->channels, 3);
    int edges = 0;
    for (int i = 0; i < over->width * over->height; i++) {
        const float *p = light->data + (size_t)(4 * i), *a = alone->data + (size_t)(4 * i);
        float behind[3];
        const WrBackground gradient = { WR_BACKGROUND_GRADIENT,
                                        { 0.9, 0.1, 0.1 },
                                        { 0.1, 0.1, 0.9 } };
        wr_background_row(&gradient, i / over->width, over->height, behind);
        assert_near(a[3], p[3], 0.51 / 255);
        edges += p[3] > 0 && p[3] < 1;
        for (int c = 0; c < 3; c++) {
            const float mixed = p[c] + (1 - p[3]) * behind[c];
            assert_near(over->data[3 * i + c], wr_srgb_encode(mixed < 1 ? mixed : 1), 0.52 / 255);
            if (p[3] > 0) assert_near(a[c], wr_srgb_encode(fminf(p[c] / p[3], 1)), 0.52 / 255);
        }
    }
    assert_true(edges > 100);
    wr_image_free(over);
    wr_image_free(light);
    wr_image_free(alone);
    wr_image_free(jpeg);
    wr_session_free(session);
}

/* ---- the camera ---- */

typedef struct Box {
    int x0, y0, x1, y1;
} Box;

/* Bounding box of non-empty pixels. */
static Box covered(WrSession *session, int width, int height, double turn)
{
    WrError err;
    WrFrame frame;
    Box box = { width, height, -1, -1 };
    if (!wr_session_frame(session, width, height, turn, &frame, &err)) fail_msg("%s", err.text);
    for (int i = 0; i < width * height; i++) {
        if (frame.rgba[4 * i + 3] <= 0) continue;
        const int x = i % width, y = i / width;
        box.x0 = x < box.x0 ? x : box.x0, box.x1 = x > box.x1 ? x : box.x1;
        box.y0 = y < box.y0 ? y : box.y0, box.y1 = y > box.y1 ? y : box.y1;
    }
    return box;
}

/* The silhouette keeps 2 % from the nearer pair of borders and is centred. */
static void expect_filled(WrSession *session, const char *what, int width, int height)
{
    const Box box = covered(session, width, height, 0);
    const int left = box.x0, right = width - 1 - box.x1, top = box.y0, below = height - 1 - box.y1;
    const bool tall = left + right > top + below;
    const double least = tall ? (top + below) / 2.0 / height : (left + right) / 2.0 / width;
    if (left < 1 || right < 1 || top < 1 || below < 1 || least > 0.018 || least < 0.003 ||
        abs(left - right) > 2 || abs(top - below) > 2)
        fail_msg("%s, %dx%d: %d %d %d %d pixels are left", what, width, height, left, right, top,
                 below);
}

static void a_filled_picture_has_no_room_left(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 200, 200 }, { 300, 150 }, { 120, 260 } };
    static const char *const cameras[] = { "camera perspective fov=35", "camera perspective fov=80",
                                           "camera orthographic" };
    WrSession *session = wr_session_new(NULL);
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        char line[80];
        const int *size = sizes[kind % 3];
        snprintf(line, sizeof line, "surface %s", wr_surfaces[kind]->name);
        must_run(session, line);
        must_run(session, "camera perspective eye=0.6,0.5,1 target=0,0,0 fit=on");
        must_run(session, cameras[kind / 3 % 3]);
        snprintf(line, sizeof line, "camera fill aspect=%.17g", (double)size[0] / size[1]);
        must_run(session, line);
        snprintf(line, sizeof line, "%s, %s", wr_surfaces[kind]->name, cameras[kind / 3 % 3]);
        expect_filled(session, line, size[0], size[1]);
    }
    /* Several distant objects, and a hidden one. */
    must_run(session, "surface sphere R=0.3");
    must_run(session, "object add far at=1.7,0.9,-3 size=0.5");
    must_run(session, "surface cube");
    must_run(session, "object add away at=50,0,0");
    must_run(session, "object hide");
    must_run(session, "camera fill aspect=1.5");
    expect_filled(session, "several", 300, 200);
    must_run(session, "ground on");
    must_run(session, "object hide ground");
    must_run(session, "camera fill aspect=1.5 turn=0,360");
    for (int turn = 0; turn < 360; turn += 24) {
        const Box box = covered(session, 150, 100, turn);
        assert_true(box.x0 > 0 && box.y0 > 0 && box.x1 < 149 && box.y1 < 99);
    }
    wr_session_free(session);
}

/* A fit for a 3:2 picture keeps its relative width in narrower ones, without cropping. */
static void narrower_pictures_see_the_whole(void **state)
{
    (void)state;
    static const char *const cameras[] = { "camera perspective fov=57",
                                           "camera orthographic size=1" };
    for (int kind = 0; kind < 2; kind++) {
        WrSession *session = session_of((const char *[]){ "surface bent", cameras[kind], NULL });
        must_run(session, "camera fill aspect=1.5");
        const Box wide = covered(session, 330, 220, 0), tall = covered(session, 330, 517, 0);
        assert_in_range(tall.x0, wide.x0 - 1, wide.x0 + 1);
        assert_in_range(tall.x1, wide.x1 - 1, wide.x1 + 1);
        assert_in_range(tall.y1 - tall.y0, wide.y1 - wide.y0 - 1, wide.y1 - wide.y0 + 1);
        const WrCamera before = scene_of(session)->camera;
        must_run(
            session,
            "camera pan 0,0 aspect=0.61"); /* a narrow window does not change the stored angle */
        assert_near(scene_of(session)->camera.size, before.size, 1e-12);
        assert_near(scene_of(session)->camera.frame, 1.5, 0);
        const Box again = covered(session, 330, 517, 0);
        assert_memory_equal(&again, &tall, sizeof again);
        must_run(session, kind ? "camera orthographic fit=on" : "camera perspective fit=on");
        /* from a fitted view: the frame was of another window */
        must_run(session, "camera dolly 1.25");
        assert_near(scene_of(session)->camera.frame, 0, 0);
        wr_session_free(session);
    }
}

static WrVec3 back_of(const WrSession *session)
{
    const WrCamera *camera = &scene_of(session)->camera;
    return v3_sub(camera->eye, camera->target);
}

static void assert_back(const WrSession *session, double x, double y, double z)
{
    const WrVec3 back = back_of(session);
    assert_near(back.x, x, 1e-12);
    assert_near(back.y, y, 1e-12);
    assert_near(back.z, z, 1e-12);
}

static void the_camera_goes_where_it_is_sent(void **state)
{
    (void)state;
    WrSession *session = session_of(
        (const char *[]){ "surface cube", "camera perspective eye=1,2,5 target=1,2,3", NULL });
    must_run(session, "camera from right");
    assert_back(session, 2, 0, 0);
    assert_true(scene_of(session)->posed && scene_of(session)->rotate_deg.x == 0);
    must_run(session, "camera from top");
    assert_back(session, 0, 2, 0);
    assert_true(scene_of(session)->camera.up.z == -1);
    must_run(session, "camera orbit 0,-90"); /* from above down to the front */
    assert_back(session, 0, 0, 2);
    must_run(session, "camera orbit 90,0");
    assert_back(session, 2, 0, 0);
    must_run(session, "camera orbit -90,30");
    assert_back(session, 0, 1, sqrt(3.0));
    must_run(session, "camera orbit 0,200"); /* stops at the pole */
    assert_true(back_of(session).y > 1.99 && back_of(session).z > 0);
    must_run(session, "camera from front");
    must_run(session, "camera dolly 0.5");
    assert_back(session, 0, 0, 1);
    must_run(session, "camera perspective fov=90");
    must_run(session, "camera pan 0.5,-1");
    assert_back(session, 0, 0, 1);
    assert_near(scene_of(session)->camera.target.x, 2, 1e-12);
    assert_near(scene_of(session)->camera.target.y, 0, 1e-12);
    must_run(session, "camera orthographic size=3");
    must_run(session, "camera dolly 2");
    assert_true(scene_of(session)->camera.size == 6);
    assert_int_equal(wr_session_history_position(session), 1); /* all are views */
    must_fail(session, "camera from nowhere", "front, back");
    wr_session_free(session);
}

static void views_are_kept_under_names(void **state)
{
    (void)state;
    static const char *const lines[] = { "surface cube",
                                         "rotate 10,20,30",
                                         "camera perspective eye=1,2,5 target=0.1,0,0 fov=50",
                                         "camera save \"the corner\"",
                                         "camera orthographic eye=0,0,3 size=4",
                                         "rotate pose=own",
                                         "camera save plain",
                                         "camera save aside eye=9,0,0 fov=20 kind=perspective",
                                         "camera from left",
                                         NULL };
    WrError err;
    WrSession *session = wr_session_new(&(WrSessionOptions){ .outputs = true });
    for (int i = 0; lines[i]; i++) must_run(session, lines[i]);
    must_run(session, "save kept.exr");
    must_run(session, "script kept.wrinkle");
    for (int way = 0; way < 3; way++) {
        if (way > 0) wr_session_free(session);
        if (way > 0) session = wr_session_new(NULL);
        if (way == 1) must_run(session, "open kept.exr");
        if (way == 2 && !wr_session_run_script(session, "kept.wrinkle", &err))
            fail_msg("%s", err.text);
        assert_int_equal(scene_of(session)->view_count, 3);
        assert_true(scene_of(session)->camera.eye.x < -2.9);
        must_run(session, "camera use \"the corner\"");
        assert_true(scene_of(session)->camera.fov_deg == 50 && !scene_of(session)->camera.fit);
        assert_true(scene_of(session)->rotate_deg.z == 30 && scene_of(session)->posed);
        must_run(session, "camera use plain");
        assert_true(scene_of(session)->camera.orthographic && scene_of(session)->camera.size == 4);
        assert_false(scene_of(session)->posed);
        must_run(session, "camera use aside");
        assert_true(scene_of(session)->camera.eye.x == 9 &&
                    scene_of(session)->camera.fov_deg == 20);
        assert_false(scene_of(session)->camera.orthographic);
    }
    must_run(session, "camera forget plain");
    must_fail(session, "camera use plain", "there are 2");
    must_run(session, "undo");
    must_run(session, "camera use plain");
    must_run(session, "camera save plain"); /* replaced */
    assert_int_equal(scene_of(session)->view_count, 3);
    wr_session_free(session);
}

/* ---- turning ---- */

static void only_what_shows_no_back_turns_whole(void **state)
{
    (void)state;
    static const struct {
        const char *lines[3];
        bool backs;
    } cases[] = {
        { { "surface plane" }, true },
        { { "surface disc" }, true },
        { { "surface sphere" }, false },
        { { "surface cube" }, false },
        { { "surface torus" }, false },
        { { "surface cylinder" }, false }, /* upright: seen from outside on all sides */
        { { "surface cylinder", "rotate 0,90,0" }, true },
        { { "surface revolution" }, false },
        { { "surface revolution", "rotate 0,90,0" }, true },
        { { "surface revolution profile=0,-1;0.5,0;0,1", "rotate 0,90,0" }, false },
        { { "surface revolution profile=0.2,0;0.9,0.1;1,0.6", "rotate 10,20,30" }, true },
        { { "surface formula" }, true },
        { { "surface formula x=sin(pi*v)*cos(2*pi*u) y=sin(pi*v)*sin(2*pi*u) z=-cos(pi*v)" },
          false },
        { { "surface mesh" }, true },
        { { "surface sphere", "object add sheet at=2,0,0" }, true },
        { { "surface sphere", "object add sheet at=2,0,0", "object hide" }, false },
        { { "surface sphere", "ground on" }, false },
        { { "surface plane", "ground on" }, true },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        WrSession *session = wr_session_new(NULL);
        for (int k = 0; k < 3 && cases[i].lines[k]; k++) must_run(session, cases[i].lines[k]);
        if (wr_scene_turn_shows_backs(scene_of(session)) != cases[i].backs)
            fail_msg("%s, %s", cases[i].lines[0], cases[i].lines[1] ? cases[i].lines[1] : "");
        wr_session_free(session);
    }
}

/* ---- the ground ---- */

static const WrScene *ground_of(const WrSession *session)
{
    const int i = wr_scene_object_find(scene_of(session), "ground");
    return i < 0 ? NULL : wr_scene_object(scene_of(session), i);
}

static void the_ground_lies_under_what_is_shown(void **state)
{
    (void)state;
    WrSession *session = wr_session_new(&(WrSessionOptions){ .outputs = true });
    must_run(session, "surface sphere R=0.5");
    must_run(session, "ground on");
    assert_near(ground_of(session)->at.y, -0.5, 1e-3);
    assert_near(ground_of(session)->size, 6, 1e-9);
    assert_true(wr_shape_endless(&ground_of(session)->shape));
    assert_int_equal(scene_of(session)->chosen, 0);
    const double ball = wr_scene_bounding_radius(scene_of(session), false);
    assert_near(ball, 0.5, 1e-9); /* a fitted camera ignores it */
    must_run(session, "object add box at=2,-0.3,0 size=2 turn=0,0,0");
    must_run(session, "surface cube s=0.5");
    must_run(session, "object set at=2,-0.3,0");
    must_run(session, "ground on colour=0.2,0.5,0.1"); /* created again with its former size */
    assert_near(ground_of(session)->at.y, -1.3, 1e-12);
    assert_true(ground_of(session)->material.colour.y == 0.5 && ground_of(session)->size < 6.1);
    must_run(session, "object hide");
    must_run(session, "ground on size=3 height=-0.75");
    assert_true(ground_of(session)->at.y == -0.75 && ground_of(session)->size == 3);
    must_run(session, "save kept.exr");
    WrSession *other = wr_session_new(NULL);
    must_run(other, "open kept.exr");
    assert_true(ground_of(other)->still && ground_of(other)->at.y == -0.75);
    assert_true(wr_shape_endless(&ground_of(other)->shape));
    must_run(other, "ground off");
    assert_null(ground_of(other));
    must_fail(other, "ground off", "there is no ground");
    must_run(other, "ground on size=3"); /* as before floors were endless */
    assert_false(wr_shape_endless(&ground_of(other)->shape));
    must_run(other, "ground on endless=on");
    assert_true(wr_shape_endless(&ground_of(other)->shape) && ground_of(other)->size == 3);
    must_run(other, "object choose ground");
    must_run(other, "surface torus");
    must_fail(other, "ground on endless=on", "only a plane can be endless");
    must_run(other, "object set still=off");
    must_fail(other, "ground on", "turns with the others");
    wr_session_free(session);
    wr_session_free(other);
}

/* The floor does not turn with the objects: a picture of it alone is the same for any turn. */
static void the_ground_does_not_turn(void **state)
{
    (void)state;
    WrSession *session = session_of(
        (const char *[]){ "surface cube s=0.6", "ground on size=3", "object hide \"object 1\"",
                          "object choose ground", "object set at=0.4,-0.3,0.2 turn=-90,20,0",
                          "camera perspective eye=1,1.5,4", NULL });
    WrFrame frame;
    WrError err;
    const size_t bytes = 64 * 48 * 4 * sizeof(float);
    float *first = malloc(bytes);
    assert_true(wr_session_frame(session, 64, 48, 0, &frame, &err));
    assert_true(frame.covered > 300);
    memcpy(first, frame.rgba, bytes);
    assert_true(wr_session_frame(session, 64, 48, 77, &frame, &err));
    assert_memory_equal(first, frame.rgba, bytes);
    must_run(session, "object set still=off");
    assert_true(wr_session_frame(session, 64, 48, 77, &frame, &err));
    assert_memory_not_equal(first, frame.rgba, bytes);
    free(first);
    wr_session_free(session);
}

/* ---- tables of its own ---- */

/* A document of that size with a ramp, in both file formats and as an integer picture. */
static void write_tables(const char *size)
{
    WrSession *session = wr_session_new(&(WrSessionOptions){ .outputs = true });
    char line[64];
    snprintf(line, sizeof line, "table %s", size);
    must_run(session, line);
    must_run(session, "ramp linear from=0,0 to=1,0 low=0 high=1");
    must_run(session, "layer add more");
    must_run(session, "fill 0.25");
    must_run(session, "save shell.exr");
    must_run(session, "save shell.ora");
    must_run(session, "export height shell.png depth=16");
    wr_session_free(session);
}

static float worn_at(WrSession *session, int i, int j)
{
    WrTables *tables = wr_document_tables(doc(session), scene_of(session), NULL, NULL);
    assert_non_null(tables);
    const float f = wr_field_get(
        wr_tables_at_hand(tables, scene_of(session), wr_document_field(doc(session))), i, j);
    wr_tables_free(tables);
    return f;
}

static void a_file_becomes_the_table_of_one_object(void **state)
{
    (void)state;
    static const char *const files[] = { "shell.exr", "shell.ora", "shell.png" };
    static const char *const sizes[] = { "64x48", "32x96" };
    for (int k = 0; k < 6; k++) {
        Said said = { "" };
        const WrSessionOptions options = { .outputs = true, .note = hear_note, .note_ctx = &said };
        WrSession *session = wr_session_new(&options);
        char line[80];
        write_tables(sizes[k / 3]);
        must_run(session, "table 64x48 wrap=clamp-u");
        must_run(session, "object add shell at=2,0,0");
        snprintf(line, sizeof line, "object set table=%s", files[k % 3]);
        must_run(session, line);
        assert_int_equal(doc(session)->layer_count, 2);
        assert_string_equal(scene_of(session)->layer, "shell");
        assert_near(worn_at(session, 32, 20), 0.5 + 0.5 / 64 + 0.25, k / 3 ? 0.01 : 1e-4);
        assert_true(f_at(session, 32, 20) == 0); /* no other object shows it */
        assert_true((strstr(said.text, "resampled to the table's 64x48") != NULL) == (k >= 3));
        must_run(session, "dab 0.5,0.5 radius=6 strength=2"); /* it can be painted */
        assert_true(worn_at(session, 32, 24) > 2.2 && f_at(session, 32, 24) == 0);
        must_run(session, "save kept.exr");
        WrSession *other = wr_session_new(NULL);
        must_run(other, "open kept.exr");
        assert_true(worn_at(other, 32, 24) == worn_at(session, 32, 24));
        must_run(session, "undo 2");
        assert_int_equal(doc(session)->layer_count, 1);
        assert_null(scene_of(session)->layer);
        must_run(session, "redo");
        must_run(session, line); /* again: a layer with a separate name */
        assert_string_equal(scene_of(session)->layer, "shell 2");
        must_run(session, "object hide");
        must_fail(session, "fill 1", "is hidden"); /* it would be invisible */
        must_fail(session, "object set table=shell.exr layer=1", "not both");
        must_fail(session, "object set table=none.exr", "none.exr");
        wr_session_free(session);
        wr_session_free(other);
    }
}

/* ---- sizes ---- */

static void sizes_along_the_axes_are_kept(void **state)
{
    (void)state;
    static const char *const sizes[] = {
        "1,1,2", "0.1,-0.3,0.7", "1,0,1", "-2,-2,-2", "3", "2,2,2"
    };
    for (int i = 0; i < 6; i++) {
        char line[64];
        WrSession *session = wr_session_new(&(WrSessionOptions){ .outputs = true });
        must_run(session, "surface sphere");
        must_run(session, "object add other at=1,0,0");
        snprintf(line, sizeof line, "object set size=%s", sizes[i]);
        must_run(session, line);
        assert_true((v3_len(scene_of(session)->sizes) > 0) == (i < 4));
        must_run(session, "save kept.exr");
        WrSession *other = wr_session_new(NULL);
        must_run(other, "open kept.exr");
        assert_true(wr_hash_equal(wr_session_hash(session), wr_session_hash(other)));
        assert_true(scene_of(other)->size == scene_of(session)->size);
        assert_memory_equal(&scene_of(other)->sizes, &scene_of(session)->sizes, sizeof(WrVec3));
        must_run(session, "undo");
        assert_true(scene_of(session)->size == 1 && v3_len(scene_of(session)->sizes) == 0);
        must_fail(session, "object set size=0,0,0", "1e-9 or more");
        must_fail(session, "object set size=-1", "1e-9 or more");
        must_fail(session, "object set size=1,2", "3 numbers");
        wr_session_free(session);
        wr_session_free(other);
    }
}

/* The conversion is invertible, and products are preserved. */
static void stretched_places_are_each_others_inverse(void **state)
{
    (void)state;
    WrSession *session = session_of(
        (const char *[]){ "surface cube", "object set size=2,-0.5,0", "rotate 20,30,40", NULL });
    WrPlacement place;
    assert_true(wr_scene_place(scene_of(session), 25, 1, &place, NULL));
    const WrVec3 p = { 0.3, -0.7, 0.2 }, way = { 0.2, 0.5, -0.8 };
    const WrVec3 world = wr_object_to_world(&place, p), back = wr_world_to_object(&place, world);
    for (int i = 0; i < 3; i++) assert_near((&back.x)[i], (&p.x)[i], 1e-9);
    const double product = v3_dot(way, v3_sub(world, place.position)) / place.size;
    assert_near(v3_dot(wr_place_dual_back(&place, way), v3_sub(p, place.centre)), product, 1e-12);
    assert_true(place.cofactor.x > 0 && place.cofactor.y < 0 && place.cofactor.z > 0);
    assert_near(wr_scene_bounding_radius(scene_of(session), false),
                2 * wr_shape_radius(&scene_of(session)->shape), 1e-12);
    wr_session_free(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_document_keeps_its_background),
        cmocka_unit_test(a_gradient_is_even_and_whole),
        cmocka_unit_test(surroundings_stand_behind_and_light_is_developed),
        cmocka_unit_test(edges_stand_before_their_background),
        cmocka_unit_test(a_filled_picture_has_no_room_left),
        cmocka_unit_test(narrower_pictures_see_the_whole),
        cmocka_unit_test(the_camera_goes_where_it_is_sent),
        cmocka_unit_test(views_are_kept_under_names),
        cmocka_unit_test(only_what_shows_no_back_turns_whole),
        cmocka_unit_test(the_ground_lies_under_what_is_shown),
        cmocka_unit_test(the_ground_does_not_turn),
        cmocka_unit_test(a_file_becomes_the_table_of_one_object),
        cmocka_unit_test(sizes_along_the_axes_are_kept),
        cmocka_unit_test(stretched_places_are_each_others_inverse),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
