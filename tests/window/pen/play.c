/* Sends lines to the test driver at their time:  play SOCKET <lines
   A line `w MS` waits until that many milliseconds after the last wait (1 is 1000 events per second); at the end it
   waits until the driver is done. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

static void wait_for(struct timespec *at, double ms)
{
    long long ns = at->tv_nsec + (long long)(ms * 1e6);
    at->tv_sec += ns / 1000000000;
    at->tv_nsec = ns % 1000000000;
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, at, NULL) != 0) continue;
}

int main(int count, char **arguments)
{
    struct sockaddr_un address = { .sun_family = AF_UNIX };
    struct timespec at;
    char line[256], answer[3];
    int to = socket(AF_UNIX, SOCK_STREAM, 0);
    if (count != 2 || to < 0 || strlen(arguments[1]) >= sizeof address.sun_path) return 2;
    strcpy(address.sun_path, arguments[1]);
    if (connect(to, (struct sockaddr *)&address, sizeof address) != 0) {
        perror(arguments[1]);
        return 1;
    }
    clock_gettime(CLOCK_MONOTONIC, &at);
    while (fgets(line, sizeof line, stdin)) {
        size_t length = strlen(line);
        if (line[0] == 'w') wait_for(&at, strtod(line + 1, NULL));
        else if (write(to, line, length) != (ssize_t)length) return 1;
    }
    if (write(to, "s\n", 2) != 2 || read(to, answer, 3) != 3) return 1;
    return memcmp(answer, "ok\n", 3) != 0;
}
