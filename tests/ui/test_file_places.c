/* Shortcut folders of the file dialog, and its file filter. */
#include "test.h"
#include "test_folder.h"

#include "base/memory.h"

#include "ui/app/jobs/files.h"

#include <string.h>

static void places_are_there_once(void **state)
{
    (void)state;
    char here[2048], path[3][2304];
    assert_non_null(getcwd(here, sizeof here));
    mkdir("Pictures", 0700);
    mkdir("mine", 0700);
    snprintf(path[0], sizeof path[0], "%s/mine/a.exr", here);
    snprintf(path[1], sizeof path[1], "%s/mine/b.png", here);
    snprintf(path[2], sizeof path[2], "%s/gone/c.png", here);
    char *recent[] = { path[0], path[1], path[2], NULL };
    WrFilePlace places[WR_FILE_PLACES];
    int count = wr_file_places(here, recent, places);
    assert_int_equal(count, 3); /* neither missing folders nor duplicates */
    assert_string_equal(places[0].label, "Home");
    assert_string_equal(places[0].path, here);
    assert_string_equal(places[1].label, "Pictures");
    assert_string_equal(places[2].label, "mine");
    assert_true(places[0].named && places[1].named && !places[2].named); /* a word, or a name */
    wr_file_places_free(places, count);
    assert_int_equal(wr_file_places(NULL, recent + 3, places), 0);
    char many[20][32], *all[21] = { NULL };
    for (int i = 0; i < 20; i++) {
        snprintf(many[i], sizeof many[i], "d%d", i);
        mkdir(many[i], 0700);
        snprintf(many[i], sizeof many[i], "d%d/x.png", i);
        all[i] = many[i];
    }
    count = wr_file_places(here, all, places);
    assert_int_equal(count, WR_FILE_PLACES);
    wr_file_places_free(places, count);
}

static void files_are_shown_for_what_they_can_be_read_as(void **state)
{
    (void)state;
    assert_true(wr_file_fits(WR_FILE_OPEN, "a.wrinkle"));
    assert_true(wr_file_fits(WR_FILE_OPEN, "Bark.PNG"));
    assert_false(wr_file_fits(WR_FILE_OPEN, "notes.txt"));
    assert_false(wr_file_fits(WR_FILE_OPEN, "png"));
    assert_true(wr_file_fits(WR_FILE_OPEN, "vase.STL"));
    assert_false(wr_file_fits(WR_FILE_IMPORT, "a.wrinkle"));
    assert_true(wr_file_fits(WR_FILE_MACRO, "a.wrinkle"));
    assert_false(wr_file_fits(WR_FILE_MACRO, "Bark.png"));
    assert_true(wr_file_fits(WR_FILE_STAMP, "leaf.gih"));
    assert_false(wr_file_fits(WR_FILE_COLOUR, "leaf.gih"));
    assert_true(wr_file_fits(WR_FILE_GLTF, "helmet.GLB"));
    assert_false(wr_file_fits(WR_FILE_GLTF, "helmet.png"));
    /* files that would be overwritten are shown */
    assert_true(wr_file_fits(WR_FILE_SAVE, "notes.txt"));
    assert_true(wr_file_fits(WR_FILE_GENERATE, "font.ttf"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_there_once),
        cmocka_unit_test(files_are_shown_for_what_they_can_be_read_as),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
