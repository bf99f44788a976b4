/* Benefit of slope moments, as stated on the page of measured scenes: highlights on relief far finer than a pixel are
   more accurate with one fetch than with 4 x 4 samples. */
#include "test.h"
#include "session_help.h"

#include "accuracy/metrics.h"
#include "base/error.h"
#include "command/session.h"
#include "document/document.h"
#include "render/frame/frame.h"

#define SIDE 256

static double rms_of(WrSession *session, const char *line, const WrReference *reference)
{
    WrError err;
    WrFrame frame;
    WrErrors errors;
    must_run(session, line);
    if (!wr_session_frame(session, SIDE, SIDE, 0, &frame, &err)) fail_msg("%s", err.text);
    wr_errors_measure(frame.rgba, NULL, reference, NULL, &errors);
    return errors.rms;
}

static void highlights_under_minification_are_nearest_by_moments(void **state)
{
    (void)state;
    WrError err;
    WrReference reference = { 0 };
    WrSession *session = wr_session_new(NULL);
    if (!wr_session_run_script(session, WR_SOURCE_DIR "/samples/accuracy/highlights.wrinkle", &err))
        fail_msg("%s", err.text);
    const WrReferenceRequest wanted = { .field = wr_document_field(doc(session)),
                                        .scene = doc(session)->scene,
                                        .width = SIDE,
                                        .height = SIDE,
                                        .most = 16 };
    assert_true(wr_reference_render(&wanted, NULL, &reference, &err));
    const double one = rms_of(session, "dials aa=point", &reference);
    const double filtered = rms_of(session, "dials aa=filter", &reference);
    const double moments = rms_of(session, "dials aa=moments moments=lean", &reference);
    const double many = rms_of(session, "dials aa=supersample samples=4", &reference);
    /* With the nearest slopes 4 x 4 samples are more accurate, 2 x 2 are not. */
    must_run(session, "bump scheme=bspline-fit mode=exact");
    const double few = rms_of(session, "dials aa=supersample samples=2", &reference);
    if (!(moments < few)) fail_msg("moments %g, 2 x 2 samples at their best %g", moments, few);
    if (!(moments < many && many < one && moments < 0.5 * filtered))
        fail_msg("one sample %g, filtered %g, moments %g, 4 x 4 samples %g", one, filtered, moments,
                 many);
    wr_reference_fini(&reference);
    wr_session_free(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(highlights_under_minification_are_nearest_by_moments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
