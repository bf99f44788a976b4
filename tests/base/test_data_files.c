/* Files installed with the program are found; also run by outside.sh, from another build folder. */
#include "test.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_brushes_and_guide_are_found_without_being_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
