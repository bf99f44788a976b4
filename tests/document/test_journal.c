/* Writing and reading of the journal: round trips, strokes, damage, kills. */
#include "test.h"
#include "journal_help.h"

#include "base/error.h"
#include "document/recovery_journal.h"

static void assert_read(const char *path, WrJournalRead *read)
{
    WrError err = { "" };
    if (!wr_journal_read(path, read, &err)) fail_msg("%s", err.text);
}

static void what_was_written_is_read_back(void **state)
{
    WrJournalOptions options = { .folder = *state, .program = "1.2 \\beta", .sync_seconds = -1 };
    WrJournalStart start = { .kind = WR_JOURNAL_DOCUMENT,
                             .hash = { 0x123456789abcdef0ULL, 0xfedcba9876543210ULL },
                             .path = "/tmp/a b\\c\nd \xc3\xa9.exr",
                             .sha256 = "0123456789abcdef0123456789abcdef"
                                       "0123456789abcdef0123456789abcdef" };
    const char *lines[] = { "dab 0.5,0.5 radius=3", "",  "text \"\\\\ \xe2\x82\xac\"",
                            "one\ntwo\r\n\\n",      " ", "\\" };
    const int count = sizeof lines / sizeof *lines;
    WrJournal *journal = wr_journal_begin(&options, &start);
    assert_true(wr_journal_state(journal).safe);
    char *path = wr_strdup(wr_journal_path(journal));
    for (int i = 0; i < count; i++) {
        WrHash hash = { (uint64_t)i, 7 };
        assert_true(wr_journal_command(journal, lines[i], NULL));
        assert_true(wr_journal_note(journal, "for people", NULL));
        assert_true(wr_journal_done(journal, WR_JOURNAL_OK, i % 2 ? &hash : NULL, NULL));
    }
    wr_journal_leave(journal);
    WrJournalRead read;
    assert_read(path, &read);
    assert_string_equal(read.program, options.program);
    assert_int_equal(read.start.kind, WR_JOURNAL_DOCUMENT);
    assert_true(wr_hash_equal(read.start.hash, start.hash));
    assert_string_equal(read.start.path, start.path);
    assert_string_equal(read.start.sha256, start.sha256);
    assert_null(read.start.snapshot);
    assert_true(llabs(read.started - (int64_t)time(NULL)) < 60);
    assert_int_equal(read.count, count);
    for (int i = 0; i < count; i++) {
        assert_string_equal(read.lines[i].text, lines[i]);
        assert_true(read.lines[i].done && !read.lines[i].stroke);
        assert_int_equal(read.lines[i].hashed, i % 2);
        if (i % 2) assert_true(read.lines[i].hash.low == (uint64_t)i);
    }
    assert_false(read.unfinished || read.in_stroke || read.dropped_bytes || *read.damage);
    wr_journal_read_fini(&read);
    wr_free(path);
}

static void commands_that_failed_are_left_out(void **state)
{
    WrJournal *journal = begin_at(*state);
    WrJournalRead read;
    wr_journal_command(journal, "first", NULL);
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    wr_journal_command(journal, "fails", NULL);
    wr_journal_done(journal, WR_JOURNAL_DROPPED, NULL, NULL);
    wr_journal_command(journal, "second", NULL);
    assert_read(wr_journal_path(journal), &read);
    assert_int_equal(read.count, 2);
    assert_string_equal(read.lines[0].text, "first");
    assert_string_equal(read.lines[1].text, "second");
    assert_true(read.unfinished && read.lines[0].done && !read.lines[1].done);
    wr_journal_read_fini(&read);
    wr_journal_finish(journal);
}

/* ---- strokes ---- */

static void a_stroke_is_put_together_from_its_samples(void **state)
{
    WrJournal *journal = begin_at(*state);
    WrJournalRead read;
    assert_true(wr_journal_stroke_begin(journal, "stroke radius=2 points=", NULL));
    assert_true(wr_journal_stroke_add(journal, "0.1,0.2;0.3,0.4", NULL));
    assert_true(wr_journal_state(journal).busy);
    assert_read(wr_journal_path(journal), &read); /* still being drawn */
    assert_int_equal(read.count, 1);
    assert_string_equal(read.lines[0].text, "stroke radius=2 points=0.1,0.2;0.3,0.4");
    assert_true(read.unfinished && read.in_stroke && read.lines[0].stroke && !read.lines[0].done);
    wr_journal_read_fini(&read);
    assert_true(wr_journal_stroke_add(journal, "0.5,0.6", NULL));
    assert_true(wr_journal_stroke_end(journal, NULL));
    assert_read(wr_journal_path(journal), &read); /* drawn, but not recorded as applied */
    assert_string_equal(read.lines[0].text, "stroke radius=2 points=0.1,0.2;0.3,0.4;0.5,0.6");
    assert_true(read.unfinished && !read.in_stroke);
    wr_journal_read_fini(&read);
    assert_true(wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL));
    assert_read(wr_journal_path(journal), &read);
    assert_true(read.count == 1 && !read.unfinished && read.lines[0].done);
    wr_journal_read_fini(&read);
    wr_journal_finish(journal);
}

static void strokes_without_samples_or_cancelled_leave_nothing(void **state)
{
    WrJournal *journal = begin_at(*state);
    WrJournalRead read;
    wr_journal_stroke_begin(journal, "stroke points=", NULL); /* without samples */
    wr_journal_stroke_end(journal, NULL);
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    wr_journal_stroke_begin(journal, "stroke points=", NULL); /* cancelled while open */
    wr_journal_stroke_add(journal, "0,0", NULL);
    wr_journal_done(journal, WR_JOURNAL_DROPPED, NULL, NULL);
    wr_journal_stroke_begin(journal, "stroke points=", NULL); /* cancelled after its end */
    wr_journal_stroke_add(journal, "0,0", NULL);
    wr_journal_stroke_end(journal, NULL);
    wr_journal_done(journal, WR_JOURNAL_DROPPED, NULL, NULL);
    wr_journal_command(journal, "kept", NULL);
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    wr_journal_stroke_begin(journal, "stroke points=", NULL); /* killed before the first sample */
    assert_read(wr_journal_path(journal), &read);
    assert_int_equal(read.count, 1);
    assert_string_equal(read.lines[0].text, "kept");
    assert_false(read.unfinished || read.in_stroke);
    wr_journal_read_fini(&read);
    wr_journal_finish(journal);
}

static void samples_without_a_stroke_are_refused(void **state)
{
    WrJournal *journal = begin_at(*state);
    WrError err;
    int64_t bytes = wr_journal_state(journal).bytes;
    assert_false(wr_journal_stroke_add(journal, "0,0", &err));
    assert_false(wr_journal_stroke_end(journal, &err));
    assert_true(wr_journal_done(journal, WR_JOURNAL_OK, NULL, &err)); /* nothing is open */
    assert_true(wr_journal_state(journal).safe && wr_journal_state(journal).bytes == bytes);
    wr_journal_finish(journal);
}

/* ---- damage ---- */

/* "command 0", "command 1", ... each with its end; the file's bytes. The caller frees both. */
static WrText make_small(const char *folder, int commands, char **path)
{
    WrJournal *journal = begin_at(folder);
    for (int i = 0; i < commands; i++) {
        char text[32];
        snprintf(text, sizeof text, "command %d", i);
        wr_journal_command(journal, text, NULL);
        wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    }
    *path = wr_strdup(wr_journal_path(journal));
    WrText bytes = read_bytes(*path);
    wr_journal_leave(journal);
    return bytes;
}

/* A journal of make_small of which `records` records are valid; the valid part ends at `good`. */
static void assert_prefix(const WrJournalRead *read, int records, size_t good, size_t size)
{
    assert_int_equal(read->count, (records + 1) / 2);  /* c d c d ... */
    if (read->total == read->count && read->lost <= 1) /* no complete record after it */
        assert_int_equal(read->unfinished, records % 2);
    for (int i = 0; i < read->count; i++) {
        char text[32];
        snprintf(text, sizeof text, "command %d", i);
        assert_string_equal(read->lines[i].text, text);
    }
    assert_int_equal(read->dropped_bytes, size - good);
    assert_int_equal(*read->damage != '\0', size != good);
}

/* Number of complete lines in bytes[0..length), and the end of the last. */
static int count_lines(const char *bytes, size_t length, size_t *end)
{
    int lines = 0;
    *end = 0;
    for (size_t i = 0; i < length; i++)
        if (bytes[i] == '\n') {
            lines++;
            *end = i + 1;
        }
    return lines;
}

static void a_torn_tail_is_dropped_at_whichever_byte_it_is_torn(void **state)
{
    char *path;
    WrText bytes = make_small(*state, 6, &path);
    size_t end, from = bytes.length;
    for (int lines = 0; lines < 4; from--) lines += bytes.data[from - 1] == '\n';
    for (size_t cut = from; cut <= bytes.length; cut++) {
        WrJournalRead read;
        write_bytes(path, bytes.data, cut);
        assert_read(path, &read);
        int records = count_lines(bytes.data, cut, &end) - 1;
        assert_prefix(&read, records, end, cut);
        wr_journal_read_fini(&read);
    }
    wr_text_fini(&bytes);
    wr_free(path);
}

static void a_journal_that_ends_in_its_header_is_refused(void **state)
{
    char *path;
    WrText bytes = make_small(*state, 0, &path);
    for (size_t cut = 0; cut < bytes.length; cut++) {
        WrJournalRead read;
        WrError err = { "" };
        write_bytes(path, bytes.data, cut);
        assert_false(wr_journal_read(path, &read, &err));
        assert_non_null(strstr(err.text, path));
    }
    wr_text_fini(&bytes);
    wr_free(path);
}

/* Everything after one flipped bit is read except the damaged line, or two lines if the bit joined them. */
static void assert_behind(const WrJournalRead *read, const char *bytes, size_t at, int line)
{
    bool joined = bytes[at] == '\n';
    int next = 0,
        first = line + (joined ? 2 : 1); /* first valid line after the damage; 0 is the header */
    for (int i = 0; i < read->count; i++) next = i + 1;
    for (int i = read->count; i < read->total; i++) {
        int number = atoi(read->lines[i].text + strlen("command "));
        assert_true(number >= next && strncmp(read->lines[i].text, "command ", 8) == 0);
        assert_true(read->lines[i].done);
        next = number + 1;
    }
    int expected = 0; /* commands of make_small whose own line, 1 + 2k, is after the damage */
    for (int k = 0; k < 4; k++) expected += 1 + 2 * k >= first;
    assert_int_equal(read->total - read->count, expected);
    assert_true(read->lost <= 3); /* the end of a command is lost with its start */
}

static void any_flipped_bit_is_noticed_and_what_stands_before_it_is_kept(void **state)
{
    char *path;
    WrText bytes = make_small(*state, 4, &path);
    for (size_t at = 0; at < bytes.length; at++) {
        for (int bit = 0; bit < 8; bit++) {
            WrJournalRead read;
            WrError err = { "" };
            size_t good;
            int lines = count_lines(bytes.data, at, &good);
            bytes.data[at] = (char)(bytes.data[at] ^ 1 << bit);
            write_bytes(path, bytes.data, bytes.length);
            bytes.data[at] = (char)(bytes.data[at] ^ 1 << bit);
            if (!wr_journal_read(path, &read, &err)) fail_msg("byte %zu: %s", at, err.text);
            assert_int_equal(read.headless, lines == 0);
            if (lines > 0) assert_prefix(&read, lines - 1, good, bytes.length);
            else assert_true(read.count == 0 && read.total >= 3);
            assert_behind(&read, bytes.data, at, lines);
            wr_journal_read_fini(&read);
        }
    }
    wr_text_fini(&bytes);
    wr_free(path);
}

/* Write the file with lines a and b exchanged, or without b (a < 0). */
static void write_shuffled(const char *path, const WrText *bytes, int a, int b)
{
    char *starts[32], *line = bytes->data;
    int count = 0;
    for (; line < bytes->data + bytes->length; line = strchr(line, '\n') + 1)
        starts[count++] = line;
    starts[count] = line;
    WrText out = { 0 };
    for (int i = 0; i < count; i++) {
        int j = i == a ? b : i == b ? a : i;
        if (j >= 0) wr_text_add_n(&out, starts[j], (size_t)(starts[j + 1] - starts[j]));
    }
    write_bytes(path, out.data, out.length);
    wr_text_fini(&out);
}

static void lines_that_are_swapped_or_missing_in_the_middle_are_noticed(void **state)
{
    char *path;
    WrText bytes = make_small(*state, 6, &path);
    for (int b = 2; b < 12; b++) {
        WrJournalRead read;
        for (int a = -1; a < b; a++) {
            if (a == 0) continue;
            write_shuffled(path, &bytes, a, b);
            assert_read(path, &read);
            int records = (a < 0 ? b : a) - 1; /* records before the first wrong line */
            assert_int_equal(read.count, (records + 1) / 2);
            assert_true(*read.damage && read.dropped_bytes > 0 && read.lost > 0);
            wr_journal_read_fini(&read);
        }
    }
    wr_text_fini(&bytes);
    wr_free(path);
}

/* A journal of a stroke of five calls between two commands; the lines first..last (0: the header) are made
   unreadable. */
static void read_without(const char *folder, int first, int last, WrJournalRead *read)
{
    WrJournal *journal = begin_at(folder);
    wr_journal_command(journal, "before", NULL);              /* line 1 */
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);      /* 2 */
    wr_journal_stroke_begin(journal, "stroke points=", NULL); /* 3 */
    for (int i = 0; i < 5; i++) {                             /* 4..8 */
        char sample[16];
        snprintf(sample, sizeof sample, "0.%d,0", i);
        wr_journal_stroke_add(journal, sample, NULL);
    }
    wr_journal_stroke_end(journal, NULL);                /* 9 */
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL); /* 10 */
    wr_journal_command(journal, "after", NULL);          /* 11 */
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL); /* 12 */
    char *path = wr_strdup(wr_journal_path(journal));
    wr_journal_leave(journal);
    WrText bytes = read_bytes(path);
    for (size_t i = 0, line = 0; i < bytes.length; i++)
        if (bytes.data[i] == '\n') line++;
        else if ((int)line >= first && (int)line <= last) bytes.data[i] = '\0';
    write_bytes(path, bytes.data, bytes.length);
    assert_read(path, read);
    wr_text_fini(&bytes);
    wr_free(path);
}

static void what_damage_in_the_middle_of_a_stroke_leaves(void **state)
{
    const struct {
        int first, last, count, total, lost;
        const char *texts[3];
    } cases[] = {
        { 6, 6, 1, 3, 1, { "before", "stroke points=0.0,0;0.1,0;0.3,0;0.4,0", "after" } },
        { 8, 8, 1, 3, 1, { "before", "stroke points=0.0,0;0.1,0;0.2,0;0.3,0", "after" } },
        { 9, 9, 2, 3, 1, { "before", "stroke points=0.0,0;0.1,0;0.2,0;0.3,0;0.4,0", "after" } },
        { 10, 10, 2, 3, 1, { "before", "stroke points=0.0,0;0.1,0;0.2,0;0.3,0;0.4,0", "after" } },
        /* Another stroke could have begun in the gap: later samples are not added to this one. */
        { 5, 6, 2, 3, 6, { "before", "stroke points=0.0,0", "after" } },
        { 3, 3, 1, 2, 8, { "before", "after" } },
        { 1, 1, 0, 2, 2, { "stroke points=0.0,0;0.1,0;0.2,0;0.3,0;0.4,0", "after" } },
        { 2, 2, 1, 3, 1, { "before", "stroke points=0.0,0;0.1,0;0.2,0;0.3,0;0.4,0", "after" } },
        { 11, 11, 2, 2, 2, { "before", "stroke points=0.0,0;0.1,0;0.2,0;0.3,0;0.4,0" } },
        { 12, 12, 3, 3, 1, { "before", "stroke points=0.0,0;0.1,0;0.2,0;0.3,0;0.4,0", "after" } },
        { 1, 12, 0, 0, 12, { NULL } },
        { 0, 0, 0, 3, 0, { "before", "stroke points=0.0,0;0.1,0;0.2,0;0.3,0;0.4,0", "after" } },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        WrJournalRead read;
        read_without(*state, cases[i].first, cases[i].last, &read);
        if (read.count != cases[i].count || read.total != cases[i].total ||
            read.lost != cases[i].lost)
            fail_msg("case %zu: %d of %d commands, %d lines lost", i, read.count, read.total,
                     read.lost);
        for (int k = 0; k < read.total; k++)
            assert_string_equal(read.lines[k].text, cases[i].texts[k]);
        assert_true(*read.damage && read.dropped_bytes > 0);
        assert_int_equal(read.headless, cases[i].first == 0);
        int sound = cases[i].first == 0 ? cases[i].total : cases[i].count;
        assert_int_equal(wr_journal_sound_end(&read, 0, true), sound);
        assert_int_equal(wr_journal_sound_end(&read, 0, false), cases[i].count);
        assert_int_equal(read.unfinished, cases[i].first == 12); /* no record of its end */
        for (int k = 0, holed = 0; k < read.total; k++)
            if ((holed += read.lines[k].holed) > 0)
                assert_true(cases[i].last == 6 || cases[i].last == 8);
        wr_journal_read_fini(&read);
    }
}

static void a_cancelled_stroke_stays_cancelled_though_the_line_that_says_so_is_lost(void **state)
{
    WrJournal *journal = begin_at(*state);
    WrJournalRead read;
    wr_journal_stroke_begin(journal, "stroke points=", NULL);
    wr_journal_stroke_add(journal, "0,0", NULL);
    wr_journal_done(journal, WR_JOURNAL_DROPPED, NULL, NULL); /* line 3 */
    wr_journal_command(journal, "after", NULL);
    char *path = wr_strdup(wr_journal_path(journal));
    wr_journal_leave(journal);
    WrText bytes = read_bytes(path);
    *strstr(bytes.data, "dropped") = 'D';
    write_bytes(path, bytes.data, bytes.length);
    assert_read(path, &read);
    assert_true(read.count == 0 && read.total == 1 && read.lost == 1);
    assert_string_equal(read.lines[0].text, "after");
    wr_journal_read_fini(&read);
    wr_text_fini(&bytes);
    wr_free(path);
}

static void the_last_save_is_on_record(void **state)
{
    WrJournal *journal = begin_at(*state);
    WrHash first = { 3, 4 }, second = { 5, 6 };
    WrJournalRead read;
    wr_journal_command(journal, "a", NULL);
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    assert_true(wr_journal_saved(journal, "/tmp/old.exr", &first, NULL));
    wr_journal_command(journal, "b", NULL);
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    assert_true(wr_journal_saved(journal, "a b\nc.exr", &second, NULL));
    wr_journal_command(journal, "c", NULL);
    wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    assert_read(wr_journal_path(journal), &read);
    assert_true(read.count == 3 && read.saved.at == 2 && wr_hash_equal(read.saved.hash, second));
    assert_true(read.saved.path[0] == '/' && strstr(read.saved.path, "/a b\nc.exr"));
    wr_journal_read_fini(&read);
    wr_journal_finish(journal);
}

/* Written by format 1: each checksum includes that of the previous line. */
static const char old_journal[] =
    "wrinkle-journal 1 df6422f71d2a45d5c6b92e0e3aad07e0 0.1.0 1795335881 empty "
    "c209fe4d3c493072d905a35e9e58fe65 \\e \\e \\e\n"
    "e7a9e309320561b43d4349fb437ac8f0 1 c table 32x32\n"
    "bb16e20a584fd83cd7f373ac3548afe6 2 d ok\n"
    "4d5699659815f4b39dd1dc0354c5e110 3 c fill 0.25\n"
    "48f826f5f3654e8a387b7ee3ca0977a4 4 d ok\n"
    "3fb4d889541937aaefa03d4d456b45f7 5 c dab 0.5,0.5 radius=4 strength=0.5\n"
    "ab9076cc3f58c90a7fd3f7844c5bab53 6 d ok\n"
    "cd72c5de34f6d5953874c7d7c41a259e 7 c undo\n"
    "06e7ebed31f06bf58c31e0c8e1a4c440 8 d ok\n"
    "9ca3e83703a3c66537da19e88bf7bcae 9 c dab 0.25,0.75 radius=6 strength=0.3\n"
    "cbf82141d8a80d46441c955020e4bb0f 10 d ok\n";

static void a_journal_of_the_old_format_is_read_whole_and_behind_damage(void **state)
{
    char *path = in(*state, "old.wj"), bytes[sizeof old_journal];
    WrJournalRead read;
    size_t size = sizeof old_journal - 1;
    write_bytes(path, old_journal, size);
    assert_read(path, &read);
    assert_true(read.count == 5 && read.total == 5 && !*read.damage && !read.dropped_bytes);
    assert_string_equal(read.lines[4].text, "dab 0.25,0.75 radius=6 strength=0.3");
    wr_journal_read_fini(&read);
    for (size_t at = 0; at < size; at++) { /* at most one line more than the damaged one */
        memcpy(bytes, old_journal, sizeof bytes);
        bytes[at] ^= 1;
        write_bytes(path, bytes, size);
        assert_read(path, &read);
        assert_true(*read.damage && read.total >= 3);
        wr_journal_read_fini(&read);
    }
    memcpy(bytes, old_journal, sizeof bytes);
    /* its checksum is readable, so the following lines can be verified */
    *strstr(bytes, "0.25") = '9';
    write_bytes(path, bytes, size);
    assert_read(path, &read);
    assert_true(read.count == 1 && read.total == 4 && read.lost == 2);
    assert_string_equal(read.lines[1].text, "dab 0.5,0.5 radius=4 strength=0.5");
    wr_journal_read_fini(&read);
    wr_free(path);
}

static void a_damaged_first_line_leaves_what_makes_sense_of_it_or_the_newest_snapshot(void **state)
{
    WrJournalRead read;
    WrJournal *journal = begin_at(*state);
    char *path = wr_strdup(wr_journal_path(journal)), *files = files_of(path);
    WrText snapshot = { 0 };
    for (int i = 0; i < 2; i++) {
        wr_text_clear(&snapshot);
        assert_true(wr_journal_snapshot_path(journal, &snapshot, NULL));
        write_bytes(wr_text_get(&snapshot), "x", 1);
    }
    wr_journal_command(journal, "a", NULL);
    wr_journal_leave(journal);
    WrText bytes = read_bytes(path);
    *strstr(bytes.data, "9.9") = '8'; /* the program's version: the rest is valid */
    write_bytes(path, bytes.data, bytes.length);
    assert_read(path, &read);
    assert_true(read.headless && read.start.kind == WR_JOURNAL_EMPTY && read.start.hash.high == 2);
    wr_journal_read_fini(&read);
    *strstr(bytes.data, "empty") = 'E'; /* nothing is valid */
    write_bytes(path, bytes.data, bytes.length);
    assert_read(path, &read);
    assert_true(read.headless && read.start.kind == WR_JOURNAL_SNAPSHOT);
    assert_string_equal(read.start.snapshot, wr_text_get(&snapshot));
    assert_true(read.count == 0 && read.total == 1);
    wr_journal_read_fini(&read);
    wr_text_fini(&bytes), wr_text_fini(&snapshot);
    wr_free(path), wr_free(files);
}

/* ---- hostile files whose checksums fit ---- */

static void write_sealed(const char *path, const WrJournalStart *start, const char *kinds,
                         const char *const *payloads)
{
    WrText text = { 0 };
    wr_journal_print_header(&text, &(WrJournalHeader){ .start = *start, .program = "x" });
    for (int i = 0; kinds[i]; i++)
        wr_journal_print_line(&text, (uint64_t)i + 1, kinds[i], payloads[i]);
    write_bytes(path, text.data, text.length);
    wr_text_fini(&text);
}

static void headers_that_make_no_sense_are_refused(void **state)
{
    const char *digits = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdeF";
    const WrJournalStart bad[] = {
        { .kind = WR_JOURNAL_SNAPSHOT, .snapshot = "../../etc/passwd" },
        { .kind = WR_JOURNAL_SNAPSHOT, .snapshot = ".." },
        { .kind = WR_JOURNAL_SNAPSHOT, .snapshot = "/etc/passwd" },
        { .kind = WR_JOURNAL_SNAPSHOT },
        { .kind = WR_JOURNAL_EMPTY, .snapshot = "snapshot-1.exr" },
        { .kind = WR_JOURNAL_DOCUMENT },
        { .kind = WR_JOURNAL_DOCUMENT, .path = "relative.exr" },
        { .kind = WR_JOURNAL_DOCUMENT, .path = "/a.exr", .sha256 = digits },
        { .kind = WR_JOURNAL_DOCUMENT, .path = "/a.exr", .sha256 = "12" },
    };
    char *path = in(*state, "a.wj");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        WrJournalRead read;
        WrError err = { "" };
        write_sealed(path, &bad[i], "", NULL);
        assert_false(wr_journal_read(path, &read, &err));
        assert_non_null(strstr(err.text, "invalid"));
    }
    wr_free(path);
}

static void records_that_make_no_sense_end_the_journal(void **state)
{
    const struct {
        const char *kinds;
        const char *payloads[3];
        const char *message;
    } bad[] = { { "cz", { "a", "b" }, "unknown kind" },
                { "cs", { "a", "0,0" }, "samples without" },
                { "ce", { "a", "" }, "without a begin" },
                { "cd", { "a", "perhaps" }, "unknown outcome" },
                { "cd", { "a", "ok 12" }, "without a hash" },
                { "cd", { "a", "ok 0123456789abcdef0123456789abcdeg" }, "without a hash" } };
    char *path = in(*state, "a.wj");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        WrJournalRead read;
        write_sealed(path, &(WrJournalStart){ 0 }, bad[i].kinds, bad[i].payloads);
        assert_read(path, &read);
        assert_int_equal(read.count, 1);
        assert_non_null(strstr(read.damage, bad[i].message));
        assert_non_null(strstr(read.damage, "line 3"));
        wr_journal_read_fini(&read);
    }
    wr_free(path);
}

static void a_journal_of_a_newer_format_is_refused_and_stays(void **state)
{
    char *path = in(*state, "a.wj");
    const char *newer[] = { "wrinkle-journal 3 anything at all\n", "wrinkle-journal 17\nx\n" };
    for (int i = 0; i < 2; i++) {
        WrJournalRead read;
        WrError err = { "" };
        write_bytes(path, newer[i], strlen(newer[i]));
        assert_false(wr_journal_read(path, &read, &err));
        assert_non_null(strstr(err.text, "newer"));
        assert_true(exists(path));
    }
    wr_free(path);
}

static void files_that_are_no_journals_are_refused(void **state)
{
    WrJournalRead read;
    WrError err = { "" };
    char *path = in(*state, "a.wj"), *link = in(*state, "b.wj"), *pipe = in(*state, "c.wj");
    assert_false(wr_journal_read(path, &read, &err));
    assert_non_null(strstr(err.text, "No such file"));
    assert_false(wr_journal_read(*state, &read, &err));
    assert_non_null(strstr(err.text, "is a folder"));
    write_bytes(path, "dab 0,0\n", 8);
    assert_false(wr_journal_read(path, &read, &err));
    assert_non_null(strstr(err.text, "not a journal"));
    WrJournal *journal = begin_at(*state); /* another user put the link there */
    assert_int_equal(symlink(wr_journal_path(journal), link), 0);
    assert_false(wr_journal_read(link, &read, &err));
    wr_journal_finish(journal);
    assert_int_equal(mkfifo(pipe, 0600), 0);
    assert_false(wr_journal_read(pipe, &read, &err)); /* and does not wait for a writer */
    wr_free(path), wr_free(link), wr_free(pipe);
}

static void endless_lines_take_bounded_memory(void **state)
{
    char *path;
    WrText bytes = make_small(*state, 2, &path);
    WrJournalRead read;
    assert_int_equal(truncate(path, (off_t)3 << 30), 0); /* a hole: zeros without a line end */
    assert_read(path, &read);
    assert_int_equal(read.count, 2);
    assert_non_null(strstr(read.damage, "longer than"));
    assert_true(read.dropped_bytes == ((int64_t)3 << 30) - (int64_t)bytes.length);
    wr_journal_read_fini(&read);
    write_bytes(path, "", 0);
    assert_int_equal(truncate(path, (off_t)3 << 30), 0);
    assert_false(wr_journal_read(path, &read, NULL)); /* nor as a header */
    wr_text_fini(&bytes);
    wr_free(path);
}

static void a_line_over_the_limit_is_not_written_and_the_journal_says_so(void **state)
{
    WrJournal *journal = begin_at(*state);
    WrJournalRead read;
    WrError err = { "" };
    char *text = wr_alloc(1, (size_t)WR_JOURNAL_LINE_MAX + 1);
    memset(text, 'x', (size_t)WR_JOURNAL_LINE_MAX);
    text[WR_JOURNAL_LINE_MAX - 100] = '\0'; /* fits, with its checksum and number */
    assert_true(wr_journal_command(journal, text, &err));
    assert_true(wr_journal_done(journal, WR_JOURNAL_OK, NULL, &err));
    text[WR_JOURNAL_LINE_MAX - 100] = 'x';
    assert_false(wr_journal_command(journal, text, &err));
    assert_non_null(strstr(err.text, "over the limit"));
    assert_false(wr_journal_state(journal).safe);
    text[WR_JOURNAL_LINE_MAX - 100] = '\0';
    assert_read(wr_journal_path(journal), &read);
    assert_int_equal(read.count, 1);
    assert_string_equal(read.lines[0].text, text);
    assert_non_null(strstr(read.gap, "over the limit"));
    wr_journal_read_fini(&read);
    wr_free(text);
    wr_journal_finish(journal);
}

/* ---- kills ---- */

typedef struct Counters {
    volatile long begun, written; /* command numbers: before and after appending */
    char path[512];
} Counters;

static void write_forever(const char *folder, Counters *counters)
{
    WrJournal *journal = begin_at(folder);
    snprintf(counters->path, sizeof counters->path, "%s", wr_journal_path(journal));
    for (long i = 0;; i++) {
        char text[64];
        snprintf(text, sizeof text, "%ld", i);
        counters->begun = i + 1;
        if (i % 3 == 2) {
            wr_journal_stroke_begin(journal, text, NULL);
            wr_journal_stroke_add(journal, "-a", NULL);
            wr_journal_stroke_add(journal, "b", NULL);
            wr_journal_stroke_end(journal, NULL);
        } else {
            wr_journal_command(journal, text, NULL);
        }
        counters->written = i + 1;
        wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
    }
}

static void a_kill_at_any_moment_loses_at_most_the_command_under_way(void **state)
{
    TestRandom random = { 11 };
    Counters *counters = shared_memory(sizeof *counters);
    for (int round = 0; round < 50; round++) {
        *counters = (Counters){ 0 };
        pid_t child = fork_bound();
        if (child == 0) write_forever(*state, counters);
        await(&counters->written, 1 + (long)(test_random(&random) * 50));
        sleep_seconds(test_random(&random) * 0.003);
        kill_child(child);
        WrJournalRead read;
        assert_read(counters->path, &read);
        assert_in_range(read.count, counters->written, counters->begun);
        for (int i = 0; i < read.count; i++) {
            char text[64];
            bool open = i == read.count - 1 && read.in_stroke;
            snprintf(text, sizeof text, "%d%s", i, i % 3 == 2 ? "-a;b" : "");
            if (open) assert_memory_equal(read.lines[i].text, text, strlen(read.lines[i].text));
            else assert_string_equal(read.lines[i].text, text);
            assert_true(read.lines[i].done || (i == read.count - 1 && read.unfinished));
        }
        wr_journal_read_fini(&read);
        unlink(counters->path);
    }
    munmap(counters, sizeof *counters);
}

/* Commands are numbered from 1; a snapshot stores the number of the last one before it. */
static void restart_forever(const char *folder, Counters *counters)
{
    WrJournal *journal = begin_at(folder);
    snprintf(counters->path, sizeof counters->path, "%s", wr_journal_path(journal));
    for (long i = 1;; i++) {
        char text[64];
        snprintf(text, sizeof text, "%ld", i);
        counters->begun = i;
        wr_journal_command(journal, text, NULL);
        counters->written = i;
        wr_journal_done(journal, WR_JOURNAL_OK, NULL, NULL);
        if (i % 3 != 0) continue;
        WrText path = { 0 };
        wr_journal_snapshot_path(journal, &path, NULL);
        FILE *file = fopen(wr_text_get(&path), "w");
        if (!file || fprintf(file, "%ld", i) < 1 || fclose(file) != 0) _exit(3);
        WrJournalStart start = { .kind = WR_JOURNAL_SNAPSHOT, .snapshot = wr_text_get(&path) };
        if (!wr_journal_restart(journal, &start, NULL)) _exit(4);
        wr_text_fini(&path);
    }
}

static void a_kill_during_restarts_leaves_the_old_journal_or_the_new_one(void **state)
{
    TestRandom random = { 12 };
    Counters *counters = shared_memory(sizeof *counters);
    for (int round = 0; round < 40; round++) {
        *counters = (Counters){ 0 };
        pid_t child = fork_bound();
        if (child == 0) restart_forever(*state, counters);
        await(&counters->written, 1 + (long)(test_random(&random) * 9));
        sleep_seconds(test_random(&random) * 0.005);
        kill_child(child);
        WrJournalRead read;
        assert_read(counters->path, &read);
        long before = 0;
        if (read.start.kind == WR_JOURNAL_SNAPSHOT) {
            WrText text = read_bytes(read.start.snapshot);
            before = atol(wr_text_get(&text));
            assert_true(before > 0);
            wr_text_fini(&text);
        }
        for (int i = 0; i < read.count; i++)
            assert_int_equal(atol(read.lines[i].text), before + 1 + i);
        assert_in_range(before + read.count, counters->written, counters->begun);
        wr_journal_read_fini(&read);
    }
    munmap(counters, sizeof *counters);
}

int main(void)
{
#define PLACED(test) cmocka_unit_test_setup_teardown(test, make_place, remove_place)
    const struct CMUnitTest tests[] = {
        PLACED(what_was_written_is_read_back),
        PLACED(commands_that_failed_are_left_out),
        PLACED(a_stroke_is_put_together_from_its_samples),
        PLACED(strokes_without_samples_or_cancelled_leave_nothing),
        PLACED(samples_without_a_stroke_are_refused),
        PLACED(a_torn_tail_is_dropped_at_whichever_byte_it_is_torn),
        PLACED(a_journal_that_ends_in_its_header_is_refused),
        PLACED(any_flipped_bit_is_noticed_and_what_stands_before_it_is_kept),
        PLACED(what_damage_in_the_middle_of_a_stroke_leaves),
        PLACED(a_cancelled_stroke_stays_cancelled_though_the_line_that_says_so_is_lost),
        PLACED(the_last_save_is_on_record),
        PLACED(a_journal_of_the_old_format_is_read_whole_and_behind_damage),
        PLACED(a_damaged_first_line_leaves_what_makes_sense_of_it_or_the_newest_snapshot),
        PLACED(lines_that_are_swapped_or_missing_in_the_middle_are_noticed),
        PLACED(headers_that_make_no_sense_are_refused),
        PLACED(records_that_make_no_sense_end_the_journal),
        PLACED(a_journal_of_a_newer_format_is_refused_and_stays),
        PLACED(files_that_are_no_journals_are_refused),
        PLACED(endless_lines_take_bounded_memory),
        PLACED(a_line_over_the_limit_is_not_written_and_the_journal_says_so),
        PLACED(a_kill_at_any_moment_loses_at_most_the_command_under_way),
        PLACED(a_kill_during_restarts_leaves_the_old_journal_or_the_new_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
