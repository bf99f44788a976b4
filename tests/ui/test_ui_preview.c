/* Pictures of the patch with a tolerance: stored dials are used, chosen dials are returned. */
#include "test.h"
#include "command/session_help.h"

#include "base/memory.h"
#include "ui/patch/preview/overexposure.h"
#include "ui/patch/preview/picture.h"
#include "ui/patch/preview/preview.h"

#define SIDE 96

static const char *const ball[] = { "table 64x64",      "grid cells=4x4 width=6", "surface sphere",
                                    "bump height=0.05", "tolerance rms=0.02",     NULL };

/* The finest picture of the document with those stored dials. */
static const WrPreviewPicture *finest(WrPreview *preview, const WrSession *session,
                                      const char *kept, double turn_deg)
{
    WrError err;
    const WrDocument *document = doc(session);
    const WrPreviewRequest wish = { .field = wr_document_composite(document, NULL),
                                    .scene = document->scene,
                                    .turn_deg = turn_deg,
                                    .width = SIDE,
                                    .height = SIDE,
                                    .chosen = kept };
    wr_preview_want(preview, &wish);
    while (!wr_preview_settled(preview)) SDL_Delay(1);
    if (wr_preview_error(preview, &err)) fail_msg("%s", err.text);
    const WrPreviewPicture *picture = wr_preview_picture(preview);
    assert_int_equal(picture->level, WR_PREVIEW_FINAL);
    return picture;
}

static WrHash hash_of(const WrPreviewPicture *picture)
{
    return wr_hash_bytes(picture->bgra, (size_t)4 * SIDE * SIDE, (WrHash){ 0, 0 });
}

static WrPreview *new_preview(void)
{
    return wr_preview_new(2, "auto", SDL_USEREVENT);
}

static void what_a_view_chose_is_what_the_document_keeps(void **state)
{
    (void)state;
    WrSession *session = session_of(ball);
    WrPreview *preview = new_preview(), *other = new_preview();
    const WrPreviewPicture *picture = finest(preview, session, NULL, 0);
    assert_true(picture->chosen.any && !picture->chosen.kept && picture->chosen.met);
    const WrHash chosen = hash_of(picture);
    assert_non_null(picture->kept);
    /* Stored in the document, its picture of that size uses the same dials without a new choice ... */
    WrError err;
    WrFrame frame;
    wr_session_keep_chosen(session, picture->kept);
    if (!wr_session_frame(session, SIDE, SIDE, 0, &frame, &err)) fail_msg("%s", err.text);
    assert_int_equal(wr_session_choice(session)->studies, 0);
    /* ... and so does another view. */
    picture = finest(other, session, wr_session_chosen(session), 0);
    assert_true(picture->chosen.any && picture->chosen.kept);
    assert_string_equal(picture->kept, wr_session_chosen(session));
    assert_true(wr_hash_equal(hash_of(picture), chosen));
    wr_preview_free(preview);
    wr_preview_free(other);
    wr_session_free(session);
}

static void dials_of_another_picture_are_chosen_anew(void **state)
{
    (void)state;
    WrSession *session = session_of(ball);
    WrPreview *preview = new_preview();
    const WrPreviewPicture *picture = finest(preview, session, NULL, 0);
    char *kept = wr_strdup(picture->kept);
    picture = finest(preview, session, kept, 30); /* another turn */
    assert_true(picture->chosen.any && !picture->chosen.kept);
    assert_string_not_equal(picture->kept, kept);
    must_run(session, "dab 0.5,0.5 radius=20 strength=1"); /* another table */
    picture = finest(preview, session, kept, 0);
    assert_true(picture->chosen.any && !picture->chosen.kept);
    must_run(session, "tolerance off");
    picture = finest(preview, session, kept, 0);
    assert_true(!picture->chosen.any && !picture->kept);
    wr_free(kept);
    wr_preview_free(preview);
    wr_session_free(session);
}

static int start_events(void **state)
{
    (void)state;
    return SDL_Init(SDL_INIT_EVENTS);
}

/* After a small edit the finest picture is mended; after one of the whole table it follows on two rougher ones. */
static void a_large_edit_is_seen_roughly_at_first(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        int pictures;
    } edits[] = { { "dab 0.2,0.3 radius=5 strength=0.3", 1 },
                  { "adjust invert", 3 },
                  { "dab 0.7,0.6 radius=9 strength=0.4", 1 },
                  { "undo", 1 },
                  { "adjust multiply factor=1.5", 3 } };
    static const char *const sphere[] = { "table 256x192", "grid cells=4x4 width=6",
                                          "surface sphere", NULL };
    WrSession *session = session_of(sphere);
    WrPreview *preview = new_preview();
    uint64_t serial = finest(preview, session, NULL, 10)->serial;
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
        must_run(session, edits[i].line);
        const uint64_t next = finest(preview, session, NULL, 10)->serial;
        assert_int_equal(next - serial, edits[i].pictures);
        serial = next;
    }
    wr_preview_free(preview);
    wr_session_free(session);
}

/* A copy of the last fetched picture, updated in the reported changed region, equals the newest picture; also if
   pictures in between were skipped, and if sizes change. */
static void what_is_said_to_have_changed_makes_the_picture(void **state)
{
    (void)state;
    enum { WIDE = 37, TALL = 23 };
    static uint8_t copy[4 * WIDE * TALL];
    TestRandom r = { 77 };
    WrError err;
    /* the fetched one, the last finished one, and a free one, in any order */
    WrPreviewPicture *pictures[3];
    uint64_t had = 0;
    int few = 0, wide = WIDE, tall = TALL, last = -1;
    bool fresh = false;
    for (int k = 0; k < 3; k++) pictures[k] = wr_alloc(1, sizeof *pictures[k]);
    int taken = -1;
    for (int i = 0; i < 3000; i++) {
        if (i % 97 == 96) wide = WIDE - (int)(9 * test_random(&r));
        if (i % 101 == 100) tall = TALL - (int)(9 * test_random(&r));
        int now = 0;
        while (now == last || now == taken) now++;
        WrPreviewPicture *p = pictures[now], *before = last < 0 ? NULL : pictures[last];
        if (!wr_picture_room(p, wide, tall, &err)) fail_msg("%s", err.text);
        const bool same = before && before->width == wide && before->height == tall;
        for (int k = 0; k < 4 * wide * tall; k++)
            p->bgra[k] = same ? before->bgra[k] : (uint8_t)(256 * test_random(&r));
        for (int k = (int)(4 * test_random(&r)); k > 0; k--)
            p->bgra[(int)(4 * wide * tall * test_random(&r))] ^=
                1 + (uint8_t)(99 * test_random(&r));
        p->serial = (uint64_t)i + 1;
        wr_picture_compare(p, before);
        if (fresh) wr_picture_follow(p, before);
        last = now;
        fresh = true;
        if (test_random(&r) < 0.4) continue; /* it is skipped */
        const SDL_Rect all = { 0, 0, wide, tall };
        const SDL_Rect part = p->since == had && had != 0 ? p->changed : all;
        few += part.w * part.h < wide * tall / 2;
        for (int y = part.y; y < part.y + part.h; y++)
            memcpy(copy + 4 * (y * wide + part.x), p->bgra + 4 * (y * wide + part.x),
                   (size_t)(4 * part.w));
        assert_memory_equal(copy, p->bgra, (size_t)(4 * wide * tall));
        had = p->serial;
        taken = now;
        fresh = false;
    }
    assert_true(few > 300);
    for (int k = 0; k < 3; k++) wr_picture_free(pictures[k]);
}

static void pixels_that_are_full_in_a_colour_are_counted_and_striped(void **state)
{
    (void)state;
    enum { WIDE = 29, TALL = 11 };
    uint8_t bgra[4 * WIDE * TALL], before[4 * WIDE * TALL];
    TestRandom r = { 78 };
    int full = 0;
    for (int k = 0; k < 4 * WIDE * TALL; k++)
        bgra[k] = (uint8_t)(test_random(&r) < 0.1 ? 255 : 253 + (int)(2 * test_random(&r)));
    for (int k = 0; k < WIDE * TALL; k++)
        full += bgra[4 * k] == 255 || bgra[4 * k + 1] == 255 || bgra[4 * k + 2] == 255;
    memcpy(before, bgra, sizeof bgra);
    assert_true(full > 20 && full < 200);
    assert_near(wr_overexposed(bgra, WIDE, TALL, false) * WIDE * TALL, full, 1e-9);
    assert_memory_equal(before, bgra, sizeof bgra);
    assert_near(wr_overexposed(bgra, WIDE, TALL, true) * WIDE * TALL, full, 1e-9);
    for (int k = 0; k < WIDE * TALL; k++) {
        const uint8_t *a = bgra + 4 * k, *b = before + 4 * k;
        if (b[0] == 255 || b[1] == 255 || b[2] == 255) assert_true(a[1] == 0 && a[0] != b[0]);
        else assert_memory_equal(a, b, 4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_view_chose_is_what_the_document_keeps),
        cmocka_unit_test(dials_of_another_picture_are_chosen_anew),
        cmocka_unit_test(a_large_edit_is_seen_roughly_at_first),
        cmocka_unit_test(what_is_said_to_have_changed_makes_the_picture),
        cmocka_unit_test(pixels_that_are_full_in_a_colour_are_counted_and_striped),
    };
    return cmocka_run_group_tests(tests, start_events, NULL);
}
