/* Profile editor: the written text equals the read one, except for moved points. */
#include "test.h"

#include "base/text.h"
#include "ui/panels/profile_edit.h"

#include <string.h>

static WrProfileEdit edit_of(const char *text)
{
    WrProfileEdit edit;
    assert_true(wr_profile_edit_read(&edit, text));
    return edit;
}

static void expect(const WrProfileEdit *edit, const char *text)
{
    WrText written = { 0 };
    wr_profile_edit_write(edit, &written);
    assert_string_equal(wr_text_get(&written), text);
    wr_text_fini(&written);
}

static void what_is_read_is_written(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "0,-0.9;0.45,-0.82;0.5,0.9", "0,-1;0.34,-1;0.34,-1;0.3,0;0.3,0;0.66,0.5", /* corners */
        "0,-1;0,-1;0.5,0;0,1;0,1",                                                /* tips */
        "1,0;1.5,0.5;1,1;0.5,0.5;1,0",                                            /* a ring */
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        const WrProfileEdit edit = edit_of(texts[i]);
        expect(&edit, texts[i]);
    }
    WrProfileEdit edit;
    assert_false(wr_profile_edit_read(&edit, "0,1;nothing"));
    assert_int_equal(edit_of(texts[1]).count, 4);
    assert_true(edit_of(texts[3]).ring && edit_of(texts[3]).count == 4);
}

static void points_are_moved_added_and_taken_away(void **state)
{
    (void)state;
    WrProfileEdit edit = edit_of("0,-1;0.34,-1;0.34,-1;0.6,0;0.3,1");
    assert_int_equal(wr_profile_edit_near(&edit, 0.33, -0.98, 0.1), 1);
    assert_int_equal(wr_profile_edit_near(&edit, 0.33, -0.5, 0.1), -1);
    wr_profile_edit_move(&edit, 1, 0.4, -0.9, 0.02); /* a corner moves as one */
    expect(&edit, "0,-1;0.4,-0.9;0.4,-0.9;0.6,0;0.3,1");
    /* inside, a curve must not touch the axis */
    wr_profile_edit_move(&edit, 2, -0.3, 0.12349, 0.02);
    expect(&edit, "0,-1;0.4,-0.9;0.4,-0.9;0.02,0.123;0.3,1");
    wr_profile_edit_move(&edit, 3, 0.01, 1, 0.02); /* at an end it may */
    wr_profile_edit_move(&edit, 2, 0.6, 0, 0.02);
    expect(&edit, "0,-1;0.4,-0.9;0.4,-0.9;0.6,0;0,1");
    assert_int_equal(wr_profile_edit_add(&edit, 0.35, 0.5), 3);
    expect(&edit, "0,-1;0.4,-0.9;0.4,-0.9;0.6,0;0.35,0.5;0,1");
    assert_true(wr_profile_edit_corner(&edit, 1) && wr_profile_edit_corner(&edit, 3));
    expect(&edit, "0,-1;0.4,-0.9;0.6,0;0.35,0.5;0.35,0.5;0,1");
    assert_true(wr_profile_edit_remove(&edit, 3) && wr_profile_edit_remove(&edit, 1) &&
                wr_profile_edit_remove(&edit, 1));
    assert_false(wr_profile_edit_remove(&edit, 0)); /* two stay */
    expect(&edit, "0,-1;0,1");
}

static void a_ring_stays_a_ring_and_no_more_points_than_fit(void **state)
{
    (void)state;
    WrProfileEdit edit = edit_of("1,0;1.5,0.5;1,1;0.5,0.5;1,0");
    wr_profile_edit_move(&edit, 0, 0.9, -0.2, 0.02);
    expect(&edit, "0.9,-0.2;1.5,0.5;1,1;0.5,0.5;0.9,-0.2");
    assert_int_equal(wr_profile_edit_add(&edit, 0.6, 0.1), 4); /* between the last and the first */
    expect(&edit, "0.9,-0.2;1.5,0.5;1,1;0.5,0.5;0.6,0.1;0.9,-0.2");
    while (edit.count < WR_PROFILE_POINTS - 1) assert_true(wr_profile_edit_add(&edit, 1, 1) >= 0);
    assert_int_equal(wr_profile_edit_add(&edit, 1, 1), -1);
    assert_false(wr_profile_edit_corner(&edit, 2));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_read_is_written),
        cmocka_unit_test(points_are_moved_added_and_taken_away),
        cmocka_unit_test(a_ring_stays_a_ring_and_no_more_points_than_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
