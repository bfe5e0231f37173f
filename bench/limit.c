/* SPDX-License-Identifier: MIT */
/*
 * brume-limit: what the loads of a march cost on this machine, each by itself.
 *
 * A lookup is two words from two tables, the second at a place that the first
 * one says. So: words gathered 16, 8 and one at a time at random places of a
 * table, in a few independent streams, as a march has light samples; and a
 * chain, in which each word says where the next one is. Nanoseconds per word,
 * the median of the runs.
 */
#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#define WORDS (1u << 22) /* of a run */
#define STREAMS 4        /* of vectors */
#define SCALAR_STREAMS 8

/* Places come from a linear congruence modulo 2^32, whose high bits are the
 * place: one multiplication or two instructions, hidden behind the load. */
#define NEXT(x) ((x)*1664525u + 1013904223u)

struct table {
    const uint32_t *words;
    unsigned shift; /* of a 32-bit number, to a place */
};

typedef uint32_t measured(const struct table *, uint32_t rounds);

/// Loads ///

static uint32_t one_by_one(const struct table *t, uint32_t rounds)
{
    uint32_t x[SCALAR_STREAMS] = {1, 2, 3, 4, 5, 6, 7, 8}, sum = 0;
    for (uint32_t i = 0; i < rounds; i += SCALAR_STREAMS)
        for (int s = 0; s < SCALAR_STREAMS; s++) {
            x[s] = NEXT(x[s]);
            sum += t->words[x[s] >> t->shift];
        }
    return sum;
}

static uint32_t chain(const struct table *t, uint32_t rounds)
{
    uint32_t x = 1;
    for (uint32_t i = 0; i < rounds; i++)
        x = NEXT(x + t->words[x >> t->shift]);
    return x;
}

/* The chain without its loads: what is taken off. */
static uint32_t chain_alone(const struct table *t, uint32_t rounds)
{
    uint32_t x = 1;
    for (uint32_t i = 0; i < rounds; i++)
        x = NEXT(x + (x >> t->shift));
    return x;
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) static uint32_t gather8(const struct table *t,
                                                        uint32_t rounds)
{
    const __m256i a = _mm256_set1_epi32(1664525);
    const __m256i c = _mm256_set1_epi32(1013904223);
    const __m128i shift = _mm_cvtsi32_si128((int)t->shift);
    __m256i x[STREAMS], sum = _mm256_setzero_si256();
    for (int s = 0; s < STREAMS; s++)
        x[s] = _mm256_setr_epi32(s, 11, 222, 3333, 44444, 555555, 66, 7);
    for (uint32_t i = 0; i < rounds; i += 8 * STREAMS)
        for (int s = 0; s < STREAMS; s++) {
            x[s] = _mm256_add_epi32(_mm256_mullo_epi32(x[s], a), c);
            sum = _mm256_add_epi32(
                sum, _mm256_i32gather_epi32((const int *)t->words,
                                            _mm256_srl_epi32(x[s], shift), 4));
        }
    return (uint32_t)_mm256_extract_epi32(sum, 0);
}

__attribute__((target("avx512f"))) static uint32_t
gather16(const struct table *t, uint32_t rounds)
{
    const __m512i a = _mm512_set1_epi32(1664525);
    const __m512i c = _mm512_set1_epi32(1013904223);
    const __m128i shift = _mm_cvtsi32_si128((int)t->shift);
    __m512i x[STREAMS], sum = _mm512_setzero_si512();
    for (int s = 0; s < STREAMS; s++)
        x[s] = _mm512_setr_epi32(s, 11, 222, 3333, 44444, 555555, 66, 7, 8, 99,
                                 1010, 11111, 121212, 13, 14, 15);
    for (uint32_t i = 0; i < rounds; i += 16 * STREAMS)
        for (int s = 0; s < STREAMS; s++) {
            x[s] = _mm512_add_epi32(_mm512_mullo_epi32(x[s], a), c);
            sum = _mm512_add_epi32(
                sum, _mm512_i32gather_epi32(_mm512_srl_epi32(x[s], shift),
                                            t->words, 4));
        }
    return (uint32_t)_mm512_reduce_add_epi32(sum);
}
#endif

/// Measuring ///

struct kind {
    const char *name;
    measured *run;
};

static unsigned list_kinds(struct kind out[5])
{
    unsigned n = 0;
    out[n++] = (struct kind){"load", one_by_one};
    out[n++] = (struct kind){"chain", chain};
    out[n++] = (struct kind){"chain_alone", chain_alone};
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2"))
        out[n++] = (struct kind){"gather8", gather8};
    if (__builtin_cpu_supports("avx512f"))
        out[n++] = (struct kind){"gather16", gather16};
#endif
    return n;
}

static double nanoseconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
    double d = *(const double *)a - *(const double *)b;
    return (d > 0) - (d < 0);
}

static double median_of(measured *run, const struct table *t, int runs)
{
    static volatile uint32_t sink;
    double ns[64];
    sink = run(t, WORDS);
    for (int i = 0; i < runs; i++) {
        double from = nanoseconds(CLOCK_THREAD_CPUTIME_ID);
        sink = sink + run(t, WORDS);
        ns[i] = (nanoseconds(CLOCK_THREAD_CPUTIME_ID) - from) / WORDS;
    }
    qsort(ns, (size_t)runs, sizeof ns[0], ascending);
    return ns[runs / 2];
}

/* By n threads at once, each on its own: wall time, so for an idle machine. */
struct crowd {
    measured *run;
    const struct table *table;
};

static void *join_in(void *arg)
{
    const struct crowd *crowd = arg;
    for (int i = 0; i < 4; i++)
        crowd->run(crowd->table, WORDS);
    return NULL;
}

static double wall_of(struct crowd *crowd, bool two, int runs)
{
    double ns[64];
    for (int i = 0; i < runs; i++) {
        pthread_t other;
        double from = nanoseconds(CLOCK_MONOTONIC);
        bool made = two && pthread_create(&other, NULL, join_in, crowd) == 0;
        join_in(crowd);
        if (made)
            pthread_join(other, NULL);
        ns[i] = nanoseconds(CLOCK_MONOTONIC) - from;
    }
    qsort(ns, (size_t)runs, sizeof ns[0], ascending);
    return ns[runs / 2];
}

/* How many times the work of one thread two get done: 2 when the processors
 * share nothing, less when they are two halves of one. */
static void print_pairs(const struct kind *kinds, unsigned n, int runs)
{
    static uint32_t words[4096];
    struct table table = {words, 32 - 12};
    for (unsigned k = 0; k < n; k++) {
        struct crowd crowd = {kinds[k].run, &table};
        double one = wall_of(&crowd, false, runs);
        printf("two_%s,16,%.4f\n", kinds[k].name,
               2 * one / wall_of(&crowd, true, runs));
    }
}

int main(int argc, char **argv)
{
    int runs = argc > 1 ? atoi(argv[1]) : 7;
    struct kind kinds[5];
    unsigned n = list_kinds(kinds);
    if (argc > 2 || runs < 1 || runs > 63) {
        puts("usage: brume-limit [RUNS]\n\nPrints what loads cost, in "
             "nanoseconds per word, by the table's size; and as two_, how "
             "many times\nthe work of one thread two get done.");
        return 2;
    }
    puts("kind,kib,ns_per_word");
    /* 16 KiB to 64 MiB, every other power of two. */
    for (unsigned log2 = 12; log2 <= 24; log2 += 2) {
        uint32_t *words = calloc(1u << log2, sizeof *words);
        struct table t = {words, 32 - log2};
        if (words == NULL)
            return 1;
        for (uint32_t i = 0; i < 1u << log2; i++)
            words[i] = NEXT(i) & 0xffu;
        for (unsigned k = 0; k < n; k++)
            printf("%s,%u,%.4f\n", kinds[k].name, 4u << (log2 - 10),
                   median_of(kinds[k].run, &t, runs));
        free(words);
    }
    print_pairs(kinds, n, runs);
    return 0;
}
