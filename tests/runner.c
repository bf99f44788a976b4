/* runner.c - the tests of a module in one program: `run_MODULE NAME [FUNCTIONS]` runs tests/test_NAME.c in this process, or
   only its functions of that pattern ("layer*"); without an argument it lists them. WR_TEST_ROWS is a file of WR_TEST(NAME) lines, made by wr_test in tests/CMakeLists.txt,
   which also renames the main of each test file. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define WR_TEST(name) int wr_test_main_##name(void);
#include WR_TEST_ROWS
#undef WR_TEST

static const struct {
    const char *name;
    int (*run)(void);
} tests[] = {
#define WR_TEST(name) { #name, wr_test_main_##name },
#include WR_TEST_ROWS
#undef WR_TEST
};
enum { TESTS = sizeof tests / sizeof tests[0] };

int main(int argc, char **argv)
{
    if (argc == 3) cmocka_set_test_filter(argv[2]);
    for (int i = 0; i < TESTS; i++) {
        if ((argc == 2 || argc == 3) && strcmp(argv[1], tests[i].name) == 0) return tests[i].run();
        if (argc < 2) puts(tests[i].name);
    }
    if (argc == 2 || argc == 3)
        fprintf(stderr, "%s has no test '%s'; without a name it lists them\n", argv[0], argv[1]);
    if (argc > 3)
        fprintf(stderr, "%s takes a name and a pattern, not %d arguments\n", argv[0], argc - 1);
    return 2; /* nothing was tested */
}
