/* Between the program and the system: the k-th call that writes to a file, or makes one, goes wrong.
 *
 * FAULT_AT is k, counted from 1; 0 for none. FAULT_KIND is an errno, or 0: then that write is short, by half; or -1: then the call never returns. FAULT_COUNT is a
 * file for the number of calls.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

static atomic_long calls;

static long at(void) { const char *text = getenv("FAULT_AT"); return text ? atol(text) : 0; }
static int kind(void) { const char *text = getenv("FAULT_KIND"); return text ? atoi(text) : 0; }

static void tell(void);

/* Whether this call is the one. */
static int chosen(void) {
    if (atomic_fetch_add(&calls, 1) + 1 != at()) return 0;
    if (kind() == -1) { tell(); for (;;) pause(); }
    return 1;
}

static int is_file(int fd) { struct stat found; return fstat(fd, &found) == 0 && S_ISREG(found.st_mode); }

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define WRITE(name, type, ...)                                                                  \
    if (!is_file(fd) || !chosen()) return REAL(name)(__VA_ARGS__);                              \
    if (kind()) { errno = kind(); return -1; }

ssize_t write(int fd, const void *bytes, size_t count) {
    WRITE(write, ssize_t, fd, bytes, count)
    return REAL(write)(fd, bytes, count > 1 ? count / 2 : count);
}
ssize_t pwrite(int fd, const void *bytes, size_t count, off_t offset) {
    WRITE(pwrite, ssize_t, fd, bytes, count, offset)
    return REAL(pwrite)(fd, bytes, count > 1 ? count / 2 : count, offset);
}
ssize_t pwrite64(int fd, const void *bytes, size_t count, off64_t offset) {
    WRITE(pwrite64, ssize_t, fd, bytes, count, offset)
    return REAL(pwrite64)(fd, bytes, count > 1 ? count / 2 : count, offset);
}
ssize_t writev(int fd, const struct iovec *parts, int count) {
    WRITE(writev, ssize_t, fd, parts, count)
    return REAL(write)(fd, parts[0].iov_base, parts[0].iov_len > 1 ? parts[0].iov_len / 2 : parts[0].iov_len);
}

#define CALL(name, ...)                                                                         \
    if (chosen() && kind()) { errno = kind(); return -1; }                                      \
    return REAL(name)(__VA_ARGS__);

int fsync(int fd) { CALL(fsync, fd) }
int fdatasync(int fd) { CALL(fdatasync, fd) }
int ftruncate(int fd, off_t length) { CALL(ftruncate, fd, length) }
int ftruncate64(int fd, off64_t length) { CALL(ftruncate64, fd, length) }
int rename(const char *from, const char *to) { CALL(rename, from, to) }
int mkdir(const char *path, mode_t mode) { CALL(mkdir, path, mode) }

#define OPEN(name)                                                                              \
    int name(const char *path, int flags, ...) {                                                \
        mode_t mode = 0;                                                                        \
        if (flags & (O_CREAT | O_TMPFILE)) { va_list more; va_start(more, flags); mode = va_arg(more, mode_t); va_end(more); } \
        if ((flags & O_CREAT) && chosen() && kind()) { errno = kind(); return -1; }             \
        return REAL(name)(path, flags, mode);                                                   \
    }
OPEN(open)
OPEN(open64)

__attribute__((destructor)) static void tell(void) {
    const char *path = getenv("FAULT_COUNT");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (file) { fprintf(file, "%ld", (long)calls); fclose(file); }
}
