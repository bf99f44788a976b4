/* Files installed with the program are found; also run by outside.sh, from another build folder. */
#include "test.h"
#include "test_folder.h"

#include "base/file.h"
#include "base/text.h"

#include <stdlib.h>

static void samples_brushes_and_guide_are_found_without_being_told(void **state)
{
    (void)state;
    WrText path = { 0 };
    unsetenv("WRINKLE_DATA");
    assert_true(wr_data_find("samples/bricks.wrinkle", &path));
    assert_true(wr_data_find("brushes", &path));
    assert_true(wr_data_find("ui/guide/README.md", &path)); /* opened by F1 */
    assert_false(wr_data_find("no/such/file", &path));
    wr_text_fini(&path);
}

/* The first folder of XDG_DATA_DIRS that has the name wins; relative folders are left out. */
static void files_of_other_programs_are_found_in_xdg_data_dirs(void **state)
{
    const char *folder = *state;
    WrText dirs = { 0 }, path = { 0 }, want = { 0 };
    static const char *const folders[] = { "one", "two", "one/brushes", "two/brushes",
                                           "two/stamps" };
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        assert_int_equal(mkdir(folders[i], 0700), 0);
    wr_text_addf(&dirs, "two:/nosuch:%s/one:%s/two", folder, folder);
    setenv("XDG_DATA_DIRS", wr_text_get(&dirs), 1);
    assert_true(wr_shared_find("brushes", &path));
    wr_text_addf(&want, "%s/one/brushes", folder);
    assert_string_equal(wr_text_get(&path), wr_text_get(&want));
    assert_true(wr_shared_find("stamps", &path));
    wr_text_clear(&want);
    wr_text_addf(&want, "%s/two/stamps", folder);
    assert_string_equal(wr_text_get(&path), wr_text_get(&want));
    assert_false(wr_shared_find("fonts", &path));
    setenv("XDG_DATA_DIRS", "", 1); /* the specification's folders */
    assert_false(wr_shared_find("wrinkle/no/such/file", &path));
    unsetenv("XDG_DATA_DIRS");
    wr_text_fini(&dirs);
    wr_text_fini(&path);
    wr_text_fini(&want);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_brushes_and_guide_are_found_without_being_told),
        cmocka_unit_test(files_of_other_programs_are_found_in_xdg_data_dirs),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
