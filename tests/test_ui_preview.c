/* The patch's pictures under a tolerance: what the document keeps is used, what is chosen is handed back. */
#include "test.h"
#include "test_session_help.h"

#include "base/memory.h"
#include "ui/preview/preview.h"

#define SIDE 96

static const char *const ball[] = { "table 64x64",      "grid cells=4x4 width=6", "surface sphere",
                                    "bump height=0.05", "tolerance rms=0.02",     NULL };

/* The finest picture of the document as it stands, with those dials kept. */
static const WrPreviewPicture *finest(WrPreview *preview, const WrSession *session,
                                      const char *kept, double turn_deg)
{
    WrError err;
    const WrDocument *document = doc(session);
    const WrPreviewWish wish = { .field = wr_document_composite(document, NULL),
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
    /* Handed to the document, its picture of that size takes the same dials and chooses nothing ... */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_view_chose_is_what_the_document_keeps),
        cmocka_unit_test(dials_of_another_picture_are_chosen_anew),
    };
    return cmocka_run_group_tests(tests, start_events, NULL);
}
