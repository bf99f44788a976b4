/* Recovery from a damaged journal, or with a failing command; the name of the recovered document; no removal before
   everything is safe. WR_FULL=1 runs the full counts, else a tenth. */
#include "test.h"
#include "document/journal_help.h"
#include "recovery_help.h"

#include "base/error.h"
#include "command/session_internal.h"
#include "command/recovery.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"

static char *folder; /* for journals and documents; a separate one for each test */

static int setup(void **state)
{
    if (make_place(state) != 0) return -1;
    folder = *state;
    return setenv("WRINKLE_STATE", folder, 1);
}

static int count_of(int full)
{
    const char *all = getenv("WR_FULL");
    return all && *all == '1' ? full : full / 10;
}

static WrSession *new_session(bool journal)
{
    WrSessionOptions options = { .journal = journal };
    return wr_session_new(&options);
}

static void run(WrSession *session, const char *line)
{
    WrError err = { "" };
    if (!wr_session_run(session, line, &err)) fail_msg("%s: %s", line, err.text);
}

static void save(WrSession *session, const char *path)
{
    WrError err = { "" };
    if (!wr_session_save(session, path, &err)) fail_msg("%s", err.text);
}

/* Hash of the document that these lines make from an empty one. */
static WrHash made_by(const char *const *lines)
{
    WrSession *session = new_session(false);
    for (; *lines; lines++) run(session, *lines);
    WrHash hash = wr_session_hash(session);
    wr_session_free(session);
    return hash;
}

static void leave(WrSession *session)
{
    wr_session_journal_leave(session);
    wr_session_free(session);
}

static int journals(void)
{
    WrRecoverable *found;
    int count;
    assert_true(wr_recovery_list(&found, &count, NULL));
    wr_recovery_list_free(found, count);
    return count;
}

static WrSession *recover(const char *journal, bool beyond, WrRecovered *how)
{
    WrError err = { "" };
    WrSession *session = new_session(true);
    if (!wr_session_recover(session, journal, beyond, how, &err)) fail_msg("%s", err.text);
    return session;
}

static void assert_hash(const WrSession *session, WrHash want, const WrRecovered *how)
{
    if (!wr_hash_equal(wr_session_hash(session), want))
        fail_msg("not the document that it was (%s)", wr_text_get(&how->report));
}

/* Damage the journal line that contains `text`, or the first line if text is NULL. */
static void damage(const char *journal, const char *text)
{
    WrText bytes = read_bytes(journal);
    char *at = text ? strstr(bytes.data, text) : strstr(bytes.data, "empty");
    assert_non_null(at);
    *at = '!';
    write_bytes(journal, bytes.data, bytes.length);
    wr_text_fini(&bytes);
}

/* ---- damage, failing commands ---- */

static const char *const five[] = { "table 64x64",
                                    "dab 0.2,0.2 strength=0.5",
                                    "dab 0.4,0.4 strength=0.25",
                                    "dab 0.6,0.6 strength=0.125",
                                    "dab 0.8,0.8 strength=1",
                                    NULL };

static char *left_by(const char *const *lines)
{
    WrSession *session = new_session(true);
    for (; *lines; lines++) run(session, *lines);
    leave(session);
    return only_journal();
}

static void damage_in_the_middle_leaves_what_is_before_it_and_what_follows(void **state)
{
    (void)state;
    char *journal = left_by(five);
    WrRecovered how;
    damage(journal, "0.4,0.4");
    const char *const before[] = { five[0], five[1], NULL };
    const char *const all[] = { five[0], five[1], five[3], five[4], NULL };
    WrSession *session = recover(journal, false, &how);
    assert_hash(session, made_by(before), &how);
    assert_true(how.done == 2 && how.commands == 4 && !how.whole && how.more && !how.removed);
    assert_non_null(strstr(wr_text_get(&how.report), "2 of 4 commands"));
    wr_recovered_fini(&how);
    wr_session_free(session);
    assert_true(exists(journal)); /* the only copy of the rest */
    session = recover(journal, true, &how);
    assert_hash(session, made_by(all), &how);
    assert_true(how.done == 4 && !how.whole && !how.more && !how.removed);
    assert_non_null(strstr(wr_text_get(&how.report), "lines of the journal are lost"));
    wr_recovered_fini(&how);
    wr_session_free(session);
    assert_true(exists(journal));
    assert_true(wr_recovery_discard(journal, NULL));
    assert_false(exists(journal));
    wr_free(journal);
}

static void a_command_that_fails_ends_it_or_is_left_out(void **state)
{
    char *place = in(*state, "journals");
    WrJournalOptions options = { .folder = place, .sync_seconds = -1 };
    WrJournal *made = wr_journal_begin(&options, &(WrJournalStart){ .kind = WR_JOURNAL_EMPTY });
    const char *const lines[] = {
        five[0], "dab 0.5,0.5 layer=nowhere", five[1], "undo", "undo", five[2], NULL
    };
    for (int i = 0; lines[i]; i++) {
        wr_journal_command(made, lines[i], NULL);
        wr_journal_done(made, WR_JOURNAL_OK, NULL, NULL);
    }
    wr_journal_leave(made);
    char *journal = only_journal();
    WrRecovered how;
    const char *const before[] = { five[0], NULL };
    /* The second undo reverts the command that failed here: nothing of it remains to be undone. */
    const char *const rest[] = { five[0], five[2], NULL };
    WrSession *session = recover(journal, false, &how);
    assert_hash(session, made_by(before), &how);
    assert_true(how.done == 1 && how.commands == 6 && how.more && !how.whole && !how.removed);
    assert_non_null(strstr(wr_text_get(&how.report), "command 2 failed"));
    wr_recovered_fini(&how);
    wr_session_free(session);
    session = recover(journal, true, &how);
    assert_hash(session, made_by(rest), &how);
    assert_true(how.done == 5 && !how.more && !how.whole && !how.removed);
    assert_non_null(strstr(wr_text_get(&how.report), "needs missing states"));
    wr_recovered_fini(&how);
    wr_session_free(session);
    assert_true(exists(journal));
    wr_free(journal);
    wr_free(place);
}

static void undo_does_not_reach_across_what_is_lost(void **state)
{
    (void)state;
    const char *const lines[] = {
        five[0], five[1], five[2], "undo", five[3], "undo", "redo", NULL
    };
    char *journal = left_by(lines);
    WrRecovered how;
    damage(journal, "0.4,0.4");
    const char *const all[] = { five[0], five[1], five[3], NULL };
    WrSession *session = recover(journal, true, &how);
    assert_hash(session, made_by(all), &how);
    wr_recovered_fini(&how);
    wr_session_free(session);
    wr_free(journal);
}

static void a_journal_without_its_first_line_is_listed_and_gives_what_it_can(void **state)
{
    (void)state;
    char *journal = left_by(five);
    WrRecovered how;
    WrError err = { "" };
    WrRecoverable *found;
    int count;
    damage(journal, NULL);
    assert_true(wr_recovery_list(&found, &count, NULL));
    assert_true(count == 1 && found[0].headless && found[0].commands == 0 && found[0].beyond == 5);
    wr_recovery_list_free(found, count);
    WrSession *session = new_session(true);
    run(session, "table 16x16");
    WrHash kept = wr_session_hash(session);
    assert_false(wr_session_recover(session, journal, false, &how, &err));
    assert_non_null(strstr(err.text, "the start of the document is unknown"));
    assert_true(wr_hash_equal(kept, wr_session_hash(session)));
    wr_recovered_fini(&how);
    wr_session_free(session);
    session = recover(journal, true, &how);
    assert_hash(session, made_by(five), &how);
    assert_true(how.done == 5 && !how.whole && !how.removed && exists(journal));
    wr_recovered_fini(&how);
    wr_session_free(session);
    wr_free(journal);
}

static void a_first_line_whose_guess_fits_the_document_is_as_good_as_whole(void **state)
{
    (void)state;
    char *journal = left_by(five);
    WrRecovered how;
    WrText bytes = read_bytes(journal);
    bytes.data[strlen("wrinkle-journal 2 ")] ^= 1; /* damages its checksum */
    write_bytes(journal, bytes.data, bytes.length);
    wr_text_fini(&bytes);
    WrSession *session = recover(journal, false, &how);
    assert_hash(session, made_by(five), &how);
    assert_true(how.done == 5 && how.whole && how.removed);
    wr_recovered_fini(&how);
    wr_session_free(session);
    wr_free(journal);
}

static void what_cannot_be_read_is_listed_with_the_reason_and_can_be_discarded(void **state)
{
    (void)state;
    char *place = in(folder, "journals"), *newer = in(place, "newer.wj");
    WrRecoverable *found;
    int count;
    assert_int_equal(mkdir(place, 0700), 0);
    write_bytes(newer, "wrinkle-journal 9 x\nmore\n", 25);
    assert_true(wr_recovery_list(&found, &count, NULL));
    assert_true(count == 1 && found[0].error && strstr(found[0].error, "newer"));
    wr_recovery_list_free(found, count);
    assert_true(wr_recovery_discard(newer, NULL));
    assert_int_equal(journals(), 0);
    wr_free(place), wr_free(newer);
}

static void everything_can_be_had_as_a_script(void **state)
{
    (void)state;
    char *journal = left_by(five), *path = in(folder, "all.wrinkle");
    WrText text = { 0 };
    WrError err = { "" };
    assert_true(wr_recovery_script(journal, &text, &err));
    write_bytes(path, text.data, text.length);
    WrSession *session = new_session(false);
    if (!wr_session_run_script(session, path, &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(session), made_by(five)));
    damage(journal, "0.4,0.4");
    wr_text_clear(&text);
    assert_true(wr_recovery_script(journal, &text, &err));
    assert_non_null(strstr(wr_text_get(&text), "lines of the journal are lost here\ndab 0.6,0.6"));
    assert_true(exists(journal));
    wr_session_free(session);
    wr_text_fini(&text);
    wr_free(journal), wr_free(path);
}

static void a_journal_goes_only_when_the_saved_file_was_read_back(void **state)
{
    (void)state;
    char *journal = left_by(five), *good = in(folder, "good.exr"), *bad = in(folder, "bad.exr");
    WrRecovered how;
    WrError err = { "" };
    WrSession *session = new_session(false), *other = new_session(false);
    assert_true(wr_session_recover(session, journal, false, &how, &err));
    assert_true(how.whole && !how.removed && exists(journal));
    assert_null(wr_journal_claim(journal, NULL)); /* locked against others */
    run(other, "table 64x64");
    save(other, bad);
    assert_false(wr_recovered_saved(&how, session, bad, &err));
    assert_true(exists(journal));
    save(session, good);
    assert_true(wr_recovered_saved(&how, session, good, &err));
    assert_true(how.removed && !exists(journal));
    wr_recovered_fini(&how);
    wr_session_free(session);
    wr_session_free(other);
    wr_free(journal), wr_free(good), wr_free(bad);
}

/* ---- the name ---- */

/* The recovered document has that hash and that name, is unsaved, and has that many undo steps. */
static void assert_back(const char *path, WrHash want, int undo)
{
    WrRecovered how;
    char *journal = only_journal();
    WrSession *session = recover(journal, false, &how);
    assert_hash(session, want, &how);
    assert_true(how.whole && how.removed && how.done == how.commands);
    assert_string_equal(wr_session_path(session), path);
    assert_true(wr_session_revision(session) != wr_session_saved_revision(session));
    assert_int_equal(wr_session_history_position(session), undo);
    /* Killed a second time. */
    wr_recovered_fini(&how);
    leave(session);
    wr_free(journal);
    journal = only_journal();
    session = recover(journal, false, &how);
    assert_hash(session, want, &how);
    assert_string_equal(wr_session_path(session), path);
    wr_recovered_fini(&how);
    wr_session_free(session);
    wr_free(journal);
}

/* Saved as my.exr after two commands, painted on, killed; `after` changes the file afterwards. */
static void saved_and_killed(void (*after)(const char *path), int undo)
{
    char *path = in(folder, "my.exr");
    WrSession *session = new_session(true);
    run(session, five[0]);
    run(session, five[1]);
    save(session, path);
    assert_int_equal(journals(), 0); /* the session's own journal is in use */
    run(session, five[2]);
    WrHash want = wr_session_hash(session);
    leave(session);
    if (after) after(path);
    assert_back(path, want, undo);
    wr_free(path);
}

static void write_other(const char *path)
{
    WrSession *session = new_session(false);
    run(session, "table 32x32");
    save(session, path);
    wr_session_free(session);
}

static void write_garbage(const char *path)
{
    write_bytes(path, "painted over", 12);
}

static void move_away(const char *path)
{
    char *to = in(folder, "moved.exr");
    assert_int_equal(rename(path, to), 0);
    wr_free(to);
}

static void delete (const char *path)
{
    assert_int_equal(unlink(path), 0);
}

static void saved_painted_and_killed_it_comes_back_under_its_name(void **state)
{
    (void)state;
    saved_and_killed(NULL, 1); /* from the file, not from the very first command */
}

static void so_it_does_when_the_file_was_overwritten_moved_deleted_or_damaged(void **state)
{
    (void)state;
    void (*const afters[])(const char *) = { write_other, write_garbage, move_away, delete };
    for (int i = 0; i < 4; i++) saved_and_killed(afters[i], 3); /* from the lines before the save */
}

static void what_was_done_before_a_save_can_be_undone_after_it(void **state)
{
    (void)state;
    char *path = in(folder, "my.exr");
    WrSession *session = new_session(true);
    for (int i = 0; i < 4; i++) run(session, five[i]);
    save(session, path);
    run(session, "undo 2");
    run(session, five[4]);
    run(session, "undo");
    run(session, "redo");
    WrHash want = wr_session_hash(session);
    leave(session);
    assert_back(path, want, 3);
    wr_free(path);
}

static void what_was_saved_is_not_offered(void **state)
{
    (void)state;
    char *path = in(folder, "my.exr");
    WrSession *session = new_session(true);
    run(session, five[0]);
    save(session, path);
    run(session, "rotate 10,20,30"); /* a change of the view */
    leave(session);
    assert_int_equal(journals(), 0);
    session = new_session(true);
    run(session, five[0]);
    save(session, path);
    assert_true(wr_session_journal_anew(session, NULL)); /* as when a long journal is shortened */
    leave(session);
    assert_int_equal(journals(), 0);
    wr_free(path);
}

static void a_kill_between_a_save_and_its_record_leaves_the_journal_as_it_was(void **state)
{
    (void)state;
    char *path = in(folder, "my.exr");
    WrSession *session = new_session(true);
    for (int i = 0; i < 3; i++) run(session, five[i]);
    WrHash want = wr_session_hash(session);
    save(session, path);
    leave(session);
    WrText name = { 0 }, bytes;
    wr_text_addf(&name, "%s/journals", folder);
    WrJournalList list;
    assert_true(wr_journal_list(wr_text_get(&name), &list, NULL) && list.count == 1);
    bytes = read_bytes(list.entries[0].path);
    size_t end = bytes.length - 1;
    while (bytes.data[end - 1] != '\n') end--;
    assert_non_null(strstr(bytes.data + end, " v "));
    write_bytes(list.entries[0].path, bytes.data, end);
    assert_back("", want, 3);
    wr_journal_list_fini(&list);
    wr_text_fini(&name), wr_text_fini(&bytes);
    wr_free(path);
}

/* Opened, painted, saved over itself, painted: each step is recovered once. */
static void an_opened_document_comes_back_with_each_step_once(void **state)
{
    (void)state;
    char *path = in(folder, "my.exr");
    for (int saves = 0; saves < 2; saves++) {
        for (int before = 0; before < 2; before++) { /* with a step before the journal is enabled */
            WrSession *session = new_session(false);
            run(session, five[0]);
            run(session, five[1]);
            save(session, path);
            wr_session_free(session);
            session = new_session(false);
            assert_true(wr_session_open(session, path, NULL));
            if (before) run(session, five[2]);
            if (before && saves) save(session, path);
            wr_session_set_journal(session, true);
            run(session, five[3]);
            if (saves) save(session, path);
            run(session, five[4]);
            WrHash want = wr_session_hash(session);
            leave(session);
            assert_back(path, want, saves ? 1 : 2 + before);
        }
    }
    wr_free(path);
}

/* The journal of one step on a document that another program has changed since. The caller frees it. */
static char *left_by_one_step_on(const char *path, WrHash *want)
{
    WrSession *session = new_session(false);
    run(session, five[0]);
    run(session, five[1]);
    save(session, path);
    wr_session_free(session);
    session = new_session(true);
    assert_true(wr_session_open(session, path, NULL));
    run(session, five[2]);
    *want = wr_session_hash(session);
    leave(session);
    write_other(path);
    return only_journal();
}

static void write_picture(const char *path, int step)
{
    uint8_t texels[48];
    WrError err;
    for (int k = 0; k < 48; k++) texels[k] = (uint8_t)(k * step % 251);
    if (!wr_image_write_pixels(path, 8, 6, 1, WR_PIXEL_U8, true, texels, &err))
        fail_msg("%s", err.text);
}

/* The file of a generator layer's line is copied into the journal, as those of plain commands. */
static void the_file_of_a_generator_layer_comes_back(void **state)
{
    (void)state;
    for (int changed = 0; changed < 2; changed++) {
        WrRecovered how;
        WrText line = { 0 };
        char *path = in(folder, "relief.png");
        write_picture(path, 37);
        WrSession *session = new_session(true);
        run(session, "table 41x29");
        wr_text_addf(&line, "layer add from=\"picture paste %s\"", path);
        run(session, wr_text_get(&line));
        run(session, "layer set 2 change=\"size=17.3\"");
        const WrHash want = wr_field_hash(wr_document_field(wr_session_document(session)));
        leave(session);
        if (changed) write_picture(path, 41);
        char *journal = only_journal();
        session = recover(journal, false, &how);
        const WrDocument *document = wr_session_document(session);
        assert_true(wr_hash_equal(wr_field_hash(wr_document_field(document)), want));
        assert_non_null(document->layers[1].line);
        wr_recovered_fini(&how);
        wr_session_free(session);
        wr_text_fini(&line);
        wr_free(journal);
        wr_free(path);
    }
}

/* So is a file that a changed value names, relative to the folder of that time; and the layer's own file at any change. */
static void the_file_of_a_changed_value_comes_back(void **state)
{
    (void)state;
    for (int changed = 0; changed < 4; changed++) {
        WrRecovered how;
        WrText line = { 0 };
        char *path = in(folder, "relief.png"), *other = in(folder, "other relief.png");
        write_picture(path, 37);
        write_picture(other, 53);
        WrSession *session = new_session(true);
        run(session, "table 41x29");
        wr_text_addf(&line, "layer add from=\"picture paste %s\"", path);
        run(session, wr_text_get(&line));
        wr_text_clear(&line);
        wr_text_addf(&line, "layer set 2 change=\"\\\"%s\\\" size=13.7 blend=add\" opacity=0.5",
                     other);
        run(session, wr_text_get(&line));
        assert_non_null(strstr(wr_session_last_command(session), "sha256="));
        run(session, "layer set 2 change=\"height=0.61\"");
        const WrHash want = wr_field_hash(wr_document_field(wr_session_document(session)));
        leave(session);
        if (changed & 1) write_picture(other, 41);
        if (changed & 2) remove(path);
        char *journal = only_journal();
        session = recover(journal, false, &how);
        const WrDocument *document = wr_session_document(session);
        assert_true(wr_hash_equal(wr_field_hash(wr_document_field(document)), want));
        assert_non_null(document->layers[1].line);
        assert_int_equal(document->layers[1].blend, WR_BLEND_ADD);
        wr_recovered_fini(&how);
        wr_session_free(session);
        wr_text_fini(&line);
        wr_free(journal);
        wr_free(path);
        wr_free(other);
    }
}

/* The journal has a copy of the file. If that is missing too, the changed file is not used, and the journal stays. */
static void what_a_journal_began_with_comes_back_or_nothing_does(void **state)
{
    (void)state;
    WrHash want;
    WrError err = { "" };
    WrRecovered how;
    char *path = in(folder, "my.exr"), *journal = left_by_one_step_on(path, &want);
    WrSession *session = recover(journal, false, &how);
    assert_hash(session, want, &how);
    assert_true(wr_session_file_changed(session)); /* saving then needs confirmation */
    wr_recovered_fini(&how);
    wr_session_free(session);
    wr_free(journal);
    assert_int_equal(journals(), 0);

    journal = left_by_one_step_on(path, &want);
    char *files = files_of(journal);
    remove_tree(files);
    session = new_session(false);
    assert_false(wr_session_recover(session, journal, false, &how, &err));
    assert_non_null(strstr(err.text, "has changed since the journal began"));
    wr_recovered_fini(&how);
    wr_session_free(session);
    assert_int_equal(journals(), 1);
    wr_free(files), wr_free(journal), wr_free(path);
}

/* A document of one step is saved and closed; then a new session with a journal. */
static WrSession *after_saving(const char *path)
{
    WrSession *session = new_session(false);
    run(session, five[0]);
    save(session, path);
    wr_session_free(session);
    return new_session(true);
}

/* A file overwritten before the journal began cannot serve as its start. */
static void a_file_that_changed_before_the_first_step_is_no_beginning(void **state)
{
    (void)state;
    char *path = in(folder, "my.exr");
    for (int large = 0; large < 2; large++) {
        WrSession *session = after_saving(path);
        assert_true(wr_session_open(session, path, NULL));
        write_other(path);
        if (large) assert_int_equal(truncate(path, 5 << 20), 0); /* would be copied aside */
        run(session, five[1]);
        WrHash want = wr_session_hash(session);
        leave(session);
        WrRecovered how;
        char *journal = only_journal();
        session = recover(journal, false, &how);
        assert_hash(session, want, &how);
        wr_recovered_fini(&how);
        wr_session_free(session);
        wr_free(journal);
        assert_int_equal(journals(), 0);
    }
    wr_free(path);
}

/* The last lines are lost: the rest is recovered, and the journal stays. */
static void damage_at_the_end_is_not_all(void **state)
{
    (void)state;
    WrRecovered how;
    char *journal = left_by(five);
    damage(journal, five[4]);
    WrSession *session = recover(journal, false, &how);
    assert_true(how.done == 4 && !how.whole && !how.removed);
    wr_recovered_fini(&how);
    wr_session_free(session);
    assert_int_equal(journals(), 1);
    /* It also stays after the rest was saved. */
    WrError err = { "" };
    char *path = in(folder, "my.exr");
    session = new_session(false);
    assert_true(wr_session_recover(session, journal, false, &how, &err));
    save(session, path);
    assert_true(wr_recovered_saved(&how, session, path, &err));
    assert_false(how.removed);
    wr_recovered_fini(&how);
    wr_session_free(session);
    assert_int_equal(journals(), 1);
    wr_free(journal), wr_free(path);
}

/* The last command may have caused the crash, so it is tried in a child process; a command that fails had no
   effect. */
static void a_last_command_that_fails_is_left_out_and_nothing_is_missing(void **state)
{
    (void)state;
    WrRecovered how;
    char *place = in(folder, "journals");
    WrJournal *begun = begin_at(place);
    wr_journal_command(begun, five[0], NULL);
    wr_journal_done(begun, WR_JOURNAL_OK, NULL, NULL);
    wr_journal_command(begun, "layer select 9", NULL);
    wr_journal_leave(begun);
    char *journal = only_journal();
    WrSession *session = recover(journal, false, &how);
    assert_true(how.whole);
    assert_non_null(strstr(wr_text_get(&how.report), "skipped"));
    wr_recovered_fini(&how);
    wr_session_free(session);
    wr_free(journal), wr_free(place);
}

/* The earlier document was discarded; later steps are not its continuation. */
static void another_document_has_another_journal(void **state)
{
    (void)state;
    char *path = in(folder, "my.exr");
    WrSession *session = after_saving(path);
    run(session, "table 32x32");
    run(session, "fill 7");
    assert_true(wr_session_open(session, path, NULL));
    run(session, five[1]);
    WrHash want = wr_session_hash(session);
    leave(session);
    assert_back(path, want, 1);
    wr_free(path);
}

static void scripts_and_pictures_are_no_files_to_save_to(void **state)
{
    (void)state;
    char *script = in(folder, "a.wrinkle"), *path = in(folder, "my.exr"),
         *other = in(folder, "b.exr");
    write_bytes(script, "table 64x64\ndab 0.5,0.5\n", 24);
    WrSession *session = new_session(true);
    assert_true(wr_session_open(session, script, NULL));
    run(session, five[2]);
    WrHash want = wr_session_hash(session);
    leave(session);
    assert_back("", want, 3);
    session = new_session(true);
    assert_true(wr_session_open(session, script, NULL));
    save(session, path);
    run(session, five[2]);
    save(session, other);
    run(session, five[3]);
    want = wr_session_hash(session);
    leave(session);
    assert_back(other, want, 1);
    wr_free(script), wr_free(path), wr_free(other);
}

static void a_document_is_saved_in_place_only_if_nobody_changed_it(void **state)
{
    (void)state;
    char *path = in(folder, "my.exr");
    WrText own = { 0 };
    WrError err = { "" };
    WrSession *session = new_session(true);
    run(session, five[0]);
    save(session, path);
    run(session, five[1]);
    leave(session);
    char *journal = only_journal();
    assert_true(wr_recovery_own_file(journal, &own, &err));
    assert_string_equal(wr_text_get(&own), path);
    write_other(path);
    assert_false(wr_recovery_own_file(journal, &own, &err));
    assert_non_null(strstr(err.text, "changed"));
    assert_true(wr_recovery_discard(journal, NULL));
    wr_free(journal);
    journal = left_by(five);
    assert_false(wr_recovery_own_file(journal, &own, &err));
    assert_non_null(strstr(err.text, "never saved"));
    wr_text_fini(&own);
    wr_free(journal), wr_free(path);
}

/* ---- kills, among saves ---- */

#define STEPS 40

/* Saving starts threads, which do not survive a fork, so everything runs in child processes. */
typedef struct Shared {
    volatile long done;
    WrHash hashes[STEPS + 1]; /* after each number of steps */
    int offered, saved;
    char *paths[2]; /* owned */
} Shared;

/* Every fourth command is a save, to one of two files. */
static void do_step(WrSession *session, int step, char *const paths[2])
{
    char line[96];
    WrError err = { "" };
    snprintf(line, sizeof line, "dab 0.%02d,0.5 radius=%d strength=0.%02d", step * 2, 3 + step % 5,
             10 + step);
    if (step == 0) snprintf(line, sizeof line, "table 48x48");
    if (step % 9 == 8) snprintf(line, sizeof line, "undo");
    bool good = step % 4 == 3 ? wr_session_save(session, paths[step / 8 % 2], &err)
                              : wr_session_run(session, line, &err);
    if (!good) _exit(1);
}

static int make_hashes(Shared *shared)
{
    WrSession *session = new_session(false);
    shared->hashes[0] = wr_session_hash(session);
    for (int i = 0; i < STEPS; i++) {
        do_step(session, i, shared->paths);
        shared->hashes[i + 1] = wr_session_hash(session);
    }
    wr_session_free(session);
    return 0;
}

static _Noreturn void take_steps(Shared *shared)
{
    WrSession *session = new_session(true);
    for (int i = 0; i < STEPS; i++) {
        do_step(session, i, shared->paths);
        shared->done = i + 1;
    }
    for (;;) pause();
}

/* The operation in progress at the kill may have completed. */
static int look_at_what_is_left(Shared *shared)
{
    long done = shared->done;
    WrSession *session = new_session(true);
    WrRecoverable *found;
    WrRecovered how;
    int count;
    CHECK(wr_recovery_list(&found, &count, NULL) && count <= 1);
    shared->offered += count;
    shared->saved += !count;
    if (count) {
        CHECK(wr_session_recover(session, found[0].journal, false, &how, NULL));
        CHECK(how.whole && how.removed);
    } else { /* everything is saved: hash of the last step, or of the one in progress */
        long last = done % 4 == 3 ? done : done - 1;
        CHECK(last % 4 == 3);
        CHECK(wr_session_open(session, shared->paths[last / 8 % 2], NULL));
    }
    WrHash hash = wr_session_hash(session);
    wr_session_free(session);
    CHECK(wr_hash_equal(hash, shared->hashes[done]) ||
          (done < STEPS && wr_hash_equal(hash, shared->hashes[done + 1])));
    return 0;
}

static void run_child(int (*function)(Shared *shared), Shared *shared)
{
    int status, *line = shared_memory(sizeof *line);
    pid_t child = fork_bound();
    if (child == 0) {
        *line = function(shared);
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    if (status != 0 || *line) fail_msg("line %d, after %ld steps", *line, shared->done);
    munmap(line, sizeof *line);
}

static void killed_among_saves_what_is_offered_and_what_is_saved_is_all_there_was(void **state)
{
    (void)state;
    Shared *shared = shared_memory(sizeof *shared);
    TestRandom random = { 12 };
    shared->paths[0] = in(folder, "a.exr");
    shared->paths[1] = in(folder, "b.exr");
    run_child(make_hashes, shared);
    for (int round = 0; round < count_of(120); round++) {
        unlink(shared->paths[0]), unlink(shared->paths[1]);
        shared->done = 0;
        pid_t child = fork_bound();
        if (child == 0) take_steps(shared);
        await(&shared->done, 1 + (long)((STEPS - 1) * test_random(&random)));
        sleep_seconds(0.004 * test_random(&random));
        kill_child(child);
        run_child(look_at_what_is_left, shared);
    }
    print_message("%d offered, %d saved\n", shared->offered, shared->saved);
    wr_free(shared->paths[0]), wr_free(shared->paths[1]);
    munmap(shared, sizeof *shared);
}

#define PLACED(test) cmocka_unit_test_setup_teardown(test, setup, remove_place)

int main(void)
{
    const struct CMUnitTest tests[] = {
        PLACED(
            killed_among_saves_what_is_offered_and_what_is_saved_is_all_there_was), /* before any thread starts */
        PLACED(damage_in_the_middle_leaves_what_is_before_it_and_what_follows),
        PLACED(a_command_that_fails_ends_it_or_is_left_out),
        PLACED(undo_does_not_reach_across_what_is_lost),
        PLACED(a_journal_without_its_first_line_is_listed_and_gives_what_it_can),
        PLACED(a_first_line_whose_guess_fits_the_document_is_as_good_as_whole),
        PLACED(what_cannot_be_read_is_listed_with_the_reason_and_can_be_discarded),
        PLACED(everything_can_be_had_as_a_script),
        PLACED(a_journal_goes_only_when_the_saved_file_was_read_back),
        PLACED(saved_painted_and_killed_it_comes_back_under_its_name),
        PLACED(so_it_does_when_the_file_was_overwritten_moved_deleted_or_damaged),
        PLACED(what_was_done_before_a_save_can_be_undone_after_it),
        PLACED(what_was_saved_is_not_offered),
        PLACED(a_kill_between_a_save_and_its_record_leaves_the_journal_as_it_was),
        PLACED(an_opened_document_comes_back_with_each_step_once),
        PLACED(the_file_of_a_generator_layer_comes_back),
        PLACED(the_file_of_a_changed_value_comes_back),
        PLACED(what_a_journal_began_with_comes_back_or_nothing_does),
        PLACED(another_document_has_another_journal),
        PLACED(a_file_that_changed_before_the_first_step_is_no_beginning),
        PLACED(damage_at_the_end_is_not_all),
        PLACED(a_last_command_that_fails_is_left_out_and_nothing_is_missing),
        PLACED(scripts_and_pictures_are_no_files_to_save_to),
        PLACED(a_document_is_saved_in_place_only_if_nobody_changed_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
