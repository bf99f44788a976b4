/* Search for presets: collections, groups, names, and the message if there is none. */
#include "test.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/library.h"

#include <sys/stat.h>
#include <unistd.h>

static const char small[] = "{\"version\": 3, \"settings\": {}}";

/* A user data folder with two presets, one of which overrides one of MyPaint's. */
static char *own_data(void)
{
    WrError err;
    char *data = wr_strdup("/tmp/wrinkle-library-XXXXXX");
    assert_non_null(mkdtemp(data));
    assert_int_equal(setenv("XDG_DATA_HOME", data, 1), 0);
    char *folder = wr_library_user_folder(&err);
    if (!folder) fail_msg("%s", err.text);
    char *path = wr_path_join(folder, "mine.myb");
    assert_true(wr_file_write(path, small, sizeof small - 1, &err));
    wr_free(path);
    path = wr_path_join(folder, "classic");
    assert_int_equal(mkdir(path, 0777), 0);
    wr_free(path);
    path = wr_path_join(folder, "classic/charcoal.myb");
    assert_true(wr_file_write(path, small, sizeof small - 1, &err));
    wr_free(path);
    path = wr_path_join(folder, "mine_prev.png");
    assert_true(wr_file_write(path, "x", 1, &err));
    wr_free(path);
    wr_free(folder);
    return data;
}

static void remove_data(char *data)
{
    WrText command = { 0 };
    wr_text_addf(&command, "rm -r %s", data);
    assert_int_equal(system(command.data), 0);
    wr_text_fini(&command);
    wr_free(data);
}

static int count_of(const WrLibrary *library, const char *collection)
{
    int count = 0;
    for (int i = 0; i < wr_library_count(library); i++)
        count += strcmp(wr_library_entry(library, i)->collection, collection) == 0;
    return count;
}

static const WrPresetEntry *entry_of(const WrLibrary *library, const char *id)
{
    for (int i = 0; i < wr_library_count(library); i++)
        if (strcmp(wr_library_entry(library, i)->id, id) == 0) return wr_library_entry(library, i);
    fail_msg("%s is not in the library", id);
    return NULL;
}

static void presets_come_by_collection_and_group(void **state)
{
    (void)state;
    char *data = own_data();
    WrLibrary *library = wr_library_new();
    assert_int_equal(count_of(library, "user"), 2);
    assert_true(count_of(library, "wrinkle") >= 26);
    assert_int_equal(count_of(library, "mypaint2"), 196);
    assert_int_equal(count_of(library, "mypaint1"), 177);
    static const char *const order[] = { "user", "wrinkle", "mypaint2", "mypaint1" };
    int collection = 0;
    for (int i = 0; i < wr_library_count(library); i++) {
        const WrPresetEntry *entry = wr_library_entry(library, i);
        while (strcmp(order[collection], entry->collection) != 0) assert_true(++collection < 4);
        size_t length = strlen(entry->collection);
        assert_memory_equal(entry->id, entry->collection, length);
        assert_true(entry->id[length] == '/' && entry->name == entry->id + length + 1);
        assert_int_equal(access(entry->path, R_OK), 0);
        assert_true(!entry->picture || access(entry->picture, R_OK) == 0);
        if (strcmp(entry->collection, "wrinkle") == 0) assert_true(entry->group[0] != '\0');
    }
    wr_library_free(library);
    remove_data(data);
}

static void groups_and_their_order_are_those_of_order_conf(void **state)
{
    (void)state;
    WrLibrary *library = wr_library_new();
    /* As in the package's file: "Group: Classic", and these two in this order. */
    const WrPresetEntry *pencil = entry_of(library, "mypaint2/classic/pencil");
    const WrPresetEntry *charcoal = entry_of(library, "mypaint2/classic/charcoal");
    assert_string_equal(pencil->group, "Classic");
    assert_string_equal(charcoal->group, "Classic");
    assert_ptr_equal(pencil + 0, entry_of(library, "mypaint2/classic/pencil"));
    int at[2] = { -1, -1 };
    for (int i = 0; i < wr_library_count(library); i++) {
        if (wr_library_entry(library, i) == pencil) at[0] = i;
        if (wr_library_entry(library, i) == charcoal) at[1] = i;
    }
    assert_int_equal(at[1], at[0] + 1);
    assert_non_null(pencil->picture);
    assert_non_null(strstr(pencil->picture, "classic/pencil_prev.png"));
    wr_library_free(library);
}

static void expect_file(const char *name, const char *tail)
{
    WrError err;
    char *path = wr_library_find(name, &err);
    if (!path) fail_msg("%s", err.text);
    if (strlen(path) < strlen(tail) || strcmp(path + strlen(path) - strlen(tail), tail) != 0)
        fail_msg("%s gives %s, not .../%s", name, path, tail);
    wr_free(path);
}

static void a_name_without_collection_means_the_first_that_has_it(void **state)
{
    (void)state;
    char *data = own_data();
    expect_file("mine", "wrinkle/brushes/mine.myb");
    expect_file("user/mine", "wrinkle/brushes/mine.myb");
    expect_file("classic/charcoal", "wrinkle/brushes/classic/charcoal.myb"); /* the user's */
    expect_file("mypaint2/classic/charcoal", "2.0/brushes/classic/charcoal.myb");
    expect_file("mypaint1/classic/charcoal", "1.0/brushes/classic/charcoal.myb");
    expect_file("classic/pencil", "2.0/brushes/classic/pencil.myb");
    expect_file("blending_knife", "2.0/brushes/classic/blending_knife.myb");
    remove_data(data);
}

static void a_name_that_is_not_there_brings_the_nearest(void **state)
{
    (void)state;
    static const char *const rows[][2] = { { "clasic/charcoal", "mypaint2/classic/charcoal" },
                                           { "charcaol", "charcoal" },
                                           { "mypaint1/classic/knive", "mypaint1/classic/knife" } };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        WrError err;
        assert_null(wr_library_find(rows[i][0], &err));
        if (!strstr(err.text, rows[i][0]) || !strstr(err.text, "did you mean") ||
            !strstr(err.text, rows[i][1]))
            fail_msg("%s", err.text);
    }
    WrError err;
    assert_null(wr_library_find("qqqqqqqqqqqqqqqqqq", &err));
    assert_null(strstr(err.text, "did you mean"));
    assert_non_null(strstr(err.text, "must be one of the"));
    assert_null(wr_library_find("", &err));
    assert_null(wr_library_find("/no/such.myb", &err));
    assert_non_null(strstr(err.text, "/no/such.myb"));
}

static void a_file_is_meant_by_its_ending(void **state)
{
    (void)state;
    char *data = own_data();
    WrError err;
    WrText path = { 0 };
    wr_text_addf(&path, "%s/wrinkle/brushes/mine.myb", data);
    WrPreset *preset = wr_library_read(path.data, &err);
    if (!preset) fail_msg("%s", err.text);
    wr_preset_free(preset);
    preset = wr_library_read("mine", &err);
    assert_non_null(preset);
    assert_string_equal(wr_preset_name(preset), "mine");
    wr_preset_free(preset);
    wr_text_fini(&path);
    remove_data(data);
}

static void missing_folders_are_empty_ones(void **state)
{
    (void)state;
    assert_int_equal(setenv("XDG_DATA_HOME", "/no/such/folder", 1), 0);
    WrLibrary *library = wr_library_new();
    assert_int_equal(count_of(library, "user"), 0);
    wr_library_free(library);
    wr_library_free(NULL);
    WrError err;
    unsetenv("XDG_DATA_HOME");
    unsetenv("HOME");
    assert_null(wr_library_user_folder(&err));
    assert_non_null(strstr(err.text, "HOME"));
}

int main(void)
{
    setenv("WRINKLE_DATA", WR_SOURCE_DIR, 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(presets_come_by_collection_and_group),
        cmocka_unit_test(groups_and_their_order_are_those_of_order_conf),
        cmocka_unit_test(a_name_without_collection_means_the_first_that_has_it),
        cmocka_unit_test(a_name_that_is_not_there_brings_the_nearest),
        cmocka_unit_test(a_file_is_meant_by_its_ending),
        cmocka_unit_test(missing_folders_are_empty_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
