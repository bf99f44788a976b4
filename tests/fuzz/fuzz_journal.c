/* Fuzz target: journals from arbitrary bytes. The first byte selects:
   even  the rest is the file
   odd   the rest is lines of a kind and a payload, written as a journal with valid checksums. It
         is read unchanged, then with one byte changed, which must give the same commands except
         the last. */
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/recovery_journal.h"
#include "document/recover.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition)
{
    if (!condition) abort();
}

static bool read_bytes(const void *bytes, size_t length, WrJournalRead *read)
{
    WrError err = { "" };
    int fd = memfd_create("journal", MFD_CLOEXEC);
    require(fd >= 0 && write(fd, bytes, length) == (ssize_t)length && lseek(fd, 0, SEEK_SET) == 0);
    bool ok = wr_journal_read_fd(fd, "/tmp/fuzz.wj", read, &err);
    close(fd);
    require(ok || err.text[0]);
    return ok;
}

/* Invariants of every result. */
static void check(const WrJournalRead *read, size_t length)
{
    require(read->count >= 0 && read->count <= read->total && (size_t)read->total <= length);
    require(!read->unfinished || read->total > 0);
    require(!read->in_stroke || (read->unfinished && read->lines[read->total - 1].stroke));
    require(read->lost >= read->lost_at_end && read->lost_at_end >= 0);
    require(!read->saved.path || (read->saved.at >= 0 && read->saved.at <= read->total));
    require(read->count == read->total || *read->damage);
    require(read->dropped_bytes >= 0 && (size_t)read->dropped_bytes <= length);
    require(!*read->damage || read->dropped_bytes > 0);
    require((read->start.kind == WR_JOURNAL_SNAPSHOT) == (read->start.snapshot != NULL));
    size_t texts = 0;
    for (int i = 0; i < read->total; i++) {
        texts += strlen(read->lines[i].text);
        require(read->lines[i].done || (i == read->total - 1 && read->unfinished));
        require(i >= read->count || (!read->lines[i].lost && !read->lines[i].holed));
    }
    require(texts <= length);
}

static WrText seal(const uint8_t *data, size_t size)
{
    WrText text = { 0 };
    WrJournalHeader header = { .program = "fuzz", .start.path = "/a b.exr" };
    char *copy = wr_strndup((const char *)data, size), *line = copy;
    wr_journal_print_header(&text, &header);
    for (uint64_t sequence = 1; line && *line; sequence++) {
        char *end = strchr(line, '\n');
        if (end) *end = '\0';
        if (*line) wr_journal_print_line(&text, sequence, line[0], line + 1);
        line = end ? end + 1 : NULL;
    }
    wr_free(copy);
    return text;
}

static void compare_with_damaged(const WrJournalRead *whole, WrText *text, size_t at, char change)
{
    WrJournalRead part;
    text->data[at % text->length] = (char)(text->data[at % text->length] ^ change);
    if (!read_bytes(text->data, text->length, &part)) return;
    check(&part, text->length);
    require(part.count - 1 <= whole->count);
    for (int i = 0; i < part.count - 1; i++)
        require(strcmp(part.lines[i].text, whole->lines[i].text) == 0);
    wr_journal_read_fini(&part);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    WrJournalRead read;
    if (size < 4) return 0;
    if (data[0] % 2 == 0) {
        if (!read_bytes(data + 1, size - 1, &read)) return 0;
        check(&read, size - 1);
        wr_journal_read_fini(&read);
        return 0;
    }
    WrText text = seal(data + 4, size - 4);
    require(read_bytes(text.data, text.length, &read));
    check(&read, text.length);
    compare_with_damaged(&read, &text, (size_t)(data[1] << 8 | data[2]), (char)data[3]);
    wr_journal_read_fini(&read);
    wr_text_fini(&text);
    return 0;
}
