/* Export sheet: a map's picture shows the file's codes, heights are counted, and the document stores the settings. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/memory.h"
#include "export/preview.h"
#include "image/image.h"
#include "scene/scene.h"

static const char *const lines[] = { "table 31x27", "noise perlin cells=5 seed=3",
                                     "bump height=0.2", NULL };

static void pictures_are_the_codes_of_their_files(void **state)
{
    (void)state;
    static const char *const kinds[] = { "height", "normal+y", "normal-y", "curvature" };
    WrSession *session = session_of(lines);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        WrError err = { "" };
        WrExportPreview picture;
        WrExportOptions options = wr_export_default();
        const WrExportKind *kind = wr_export_find(kinds[k]);
        if (!wr_export_preview(kind, doc(session), &options, NULL, &picture, &err))
            fail_msg("%s", err.text);
        options.depth = 8;
        if (!wr_export(kind, doc(session), &options, NULL, "map.png", NULL, &err))
            fail_msg("%s", err.text);
        WrImage *image = wr_image_read("map.png", &err);
        if (!image) fail_msg("%s", err.text);
        assert_int_equal(picture.width, 31);
        assert_int_equal(picture.height, 27);
        for (int i = 0; i < 31 * 27; i++)
            for (int c = 0; c < 3; c++) {
                const int at = image->channels == 3 ? 3 * i + c : i;
                const int want = (int)lrint(255.0 * (double)image->data[at]);
                if (picture.rgb[3 * i + c] != want)
                    fail_msg("%s: texel %d: %d, not %d", kinds[k], i, picture.rgb[3 * i + c], want);
            }
        wr_image_free(image);
        wr_export_preview_fini(&picture);
    }
    wr_session_free(session);
}

/* For floats, the value of largest magnitude is white or black, and 0 is the middle. */
static void pictures_of_floats_go_to_the_ends(void **state)
{
    (void)state;
    WrSession *session = session_of(lines);
    const WrExportOptions options = wr_export_default();
    WrExportPreview picture;
    WrError err = { "" };
    int low = 255, high = 0;
    if (!wr_export_preview(wr_export_find("slopes"), doc(session), &options, NULL, &picture, &err))
        fail_msg("%s", err.text);
    for (int i = 0; i < 31 * 27; i++) {
        for (int c = 0; c < 2; c++) {
            const int code = picture.rgb[3 * i + c];
            low = code < low ? code : low, high = code > high ? code : high;
        }
        assert_in_range(picture.rgb[3 * i + 2], 127, 128);
    }
    assert_true(low == 0 || high == 255);
    wr_export_preview_fini(&picture);
    wr_session_free(session);
}

static void drawings_have_no_picture(void **state)
{
    (void)state;
    WrSession *session = session_of(lines);
    WrExportOptions options = wr_export_default();
    WrExportPreview picture;
    WrError err = { "" };
    assert_false(
        wr_export_preview(wr_export_find("stl"), doc(session), &options, NULL, &picture, &err));
    assert_non_null(strstr(err.text, "no picture"));
    wr_export_preview_fini(&picture);
    wr_session_free(session);
}

static void every_height_is_counted_once(void **state)
{
    (void)state;
    WrSession *session = session_of(lines);
    const WrHistogram all = wr_export_histogram(doc(session), -HUGE_VAL, HUGE_VAL);
    const WrHistogram some = wr_export_histogram(doc(session), -0.1, 0.2);
    int64_t sum = 0, outside = 0, upper = 0, want_upper = 0;
    for (int j = 0; j < 27; j++)
        for (int i = 0; i < 31; i++) {
            const double f = f_at(session, i, j);
            outside += f < -0.1 || f > 0.2;
            want_upper += f >= (all.low + all.high) / 2;
        }
    for (int i = 0; i < WR_HISTOGRAM; i++) {
        sum += all.count[i];
        if (i >= WR_HISTOGRAM / 2) upper += all.count[i];
    }
    assert_int_equal(sum, 31 * 27);
    assert_int_equal(upper, want_upper);
    assert_int_equal(all.outside, 0);
    assert_true(outside > 0);
    assert_int_equal(some.outside, outside);
    wr_session_free(session);
}

static void a_document_keeps_what_the_sheet_was_told(void **state)
{
    (void)state;
    WrError err = { "" };
    WrSession *session = session_of(lines), *again = wr_session_new(NULL);
    must_run(session,
             "sheet unreal folder=\"maps of mine\" name=tile depth=16 size=power range=signed");
    must_fail(session, "sheet unreal depth=12", "depth");
    if (!wr_session_save(session, "kept.exr", &err) || !wr_session_open(again, "kept.exr", &err))
        fail_msg("%s", err.text);
    const WrSheetRequest *sheet = &doc(again)->scene->sheet;
    assert_string_equal(sheet->as, "unreal");
    assert_string_equal(sheet->folder, "maps of mine");
    assert_string_equal(sheet->name, "tile");
    assert_int_equal(sheet->depth, WR_SHEET_16);
    assert_int_equal(sheet->size, WR_SHEET_POWER);
    assert_int_equal(sheet->range, WR_SHEET_RANGE_SIGNED);
    must_run(again, "object add b"); /* another object has them too */
    assert_string_equal(doc(again)->scene->sheet.as, "unreal");
    wr_session_free(session);
    wr_session_free(again);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_the_codes_of_their_files),
        cmocka_unit_test(pictures_of_floats_go_to_the_ends),
        cmocka_unit_test(drawings_have_no_picture),
        cmocka_unit_test(every_height_is_counted_once),
        cmocka_unit_test(a_document_keeps_what_the_sheet_was_told),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
