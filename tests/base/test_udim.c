/* UDIM numbers, and the files of a name with one. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/udim.h"

static void numbers_are_columns_and_rows(void **state)
{
    (void)state;
    /* 1001 + u + 10 v, as Mari counts */
    static const int known[][3] = { { 0, 0, 1001 }, { 9, 0, 1010 },   { 0, 1, 1011 },
                                    { 3, 2, 1024 }, { 8, 899, 9999 }, { 10, 0, 0 },
                                    { -1, 0, 0 },   { 0, -1, 0 },     { 9, 899, 0 },
                                    { 0, 900, 0 } };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const int number = wr_udim_number(known[i][0], known[i][1]);
        assert_int_equal(number, known[i][2]);
        if (number == 0) continue;
        assert_int_equal(wr_udim_column(number), known[i][0]);
        assert_int_equal(wr_udim_row(number), known[i][1]);
    }
    static const char *const wrong[] = { "", "1000", "101", "10011", "1001 ", "-101", "0x3e9" };
    int number;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_false(wr_udim_parse(wrong[i], &number));
    assert_true(wr_udim_parse("1017", &number));
    assert_int_equal(number, 1017);
}

static void check_name(char *made, const char *want)
{
    assert_string_equal(made, want);
    wr_free(made);
}

static void names_take_a_number(void **state)
{
    (void)state;
    assert_true(wr_udim_is_pattern("a/b.<UDIM>.png"));
    assert_false(wr_udim_is_pattern("a/b.1001.png"));
    check_name(wr_udim_fill("<UDIM>/b_<UDIM>_n.png", 1012), "1012/b_1012_n.png");
    check_name(wr_udim_fill("plain.exr", 1012), "plain.exr");
    check_name(wr_udim_insert("a.b/c_n.png", 1012), "a.b/c_n.1012.png");
    check_name(wr_udim_insert("a.b/.c", 1012), "a.b/.c.1012");
    check_name(wr_udim_insert("c.v2.exr", 1001), "c.v2.1001.exr");
}

static void write_names(const char *const *names)
{
    WrError err;
    for (; *names; names++)
        if (!wr_file_write(*names, "x", 1, &err)) fail_msg("%s", err.text);
}

static void check_files(const char *path, int own, const char *want)
{
    int numbers[4], named = -1;
    WrText list = { 0 };
    const int count = wr_udim_files(path, &named, numbers, 4);
    wr_udim_list(numbers, count < 4 ? count : 4, &list);
    assert_int_equal(named, own);
    assert_string_equal(wr_text_get(&list), want);
    wr_text_fini(&list);
}

/* Only files that differ in the number count: not those of another length, ending or number. */
static void files_of_a_name_are_found(void **state)
{
    (void)state;
    static const char *const names[] = { "rock.1011.png",    "rock.1001.png",
                                         "rock.1003.png",    "rock.0999.png",
                                         "rock.10031.png",   "rock.1004.jpeg",
                                         "rocks.1004.png",   "rock.png",
                                         "r_1001_n.exr",     "r_1012_n.exr",
                                         "r_1012_m.exr",     "two1001_1001.exr",
                                         "two1001_1002.exr", NULL };
    write_names(names);
    check_files("rock.1003.png", 1003, "1001, 1003, 1011");
    check_files("./rock.1007.png", 1007, "1001, 1003, 1011");
    check_files("rock.<UDIM>.png", 0, "1001, 1003, 1011");
    check_files("r_<UDIM>_n.exr", 0, "1001, 1012");
    check_files("two<UDIM>_<UDIM>.exr", 0, "1001");
    check_files("rock.png", 0, "");
    check_files("r_1012_n.exr", 0, "");
    check_files("rock_2048.png", 0, "");
    check_files("nowhere/rock.1001.png", 1001, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_columns_and_rows),
        cmocka_unit_test(names_take_a_number),
        cmocka_unit_test(files_of_a_name_are_found),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
