/* What the objects stand in: the background. */
#include "test.h"
#include "test_folder.h"
#include "test_session_help.h"

#include "base/text.h"
#include "image/image.h"
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

/* The borders have the two colours, the codes between go down evenly, and bands and tolerances change nothing. */
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

/* Alpha is coverage, colours are not premultiplied, and edges are mixed with what lies behind them. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_document_keeps_its_background),
        cmocka_unit_test(a_gradient_is_even_and_whole),
        cmocka_unit_test(edges_stand_before_their_background),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
