// What `inspect` reads from code and from compilers' messages: a wrong answer here would prove what is not so.
#include "bench/inspection/inspected.h"
#include "bench/inspection/machine_code.h"
#include "bench/inspection/nvcc.h"
#include "core/base/error.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

std::uint64_t fused_in_amd(const std::string& line)
{
    return read_amd("BB0:\n\t" + line + "    ; 12345678\n").fused;
}

std::uint64_t fused_in_ptx(const std::string& line)
{
    return read_ptx(".visible .entry f(\n)\n{\n\t" + line + "\n}\n", "f").fused;
}

} // namespace

TEST(MachineCode, amds_fused_instructions_are_found_wherever_they_stand)
{
    for (const char* const fused :
         {"v_fma_f32 v1, v2, v3, v4", "v_fmac_f32_e32 v1, v2, v3", "v_fmamk_f32 v1, v2, 0x3f800000, v3",
          "v_fmaak_f32 v1, v2, v3, 0x3f800000", "v_pk_fma_f16 v1, v2, v3, v4",
          "v_fma_f64 v[0:1], v[2:3], v[4:5], v[6:7]", "v_fma_mix_f32 v1, v2, v3, v4",
          "v_dual_mul_f32 v1, v2, v3 :: v_dual_fmac_f32 v4, v5, v6",
          "v1: %5:v[1] = v_fma_f32 %1:v[2], %2:v[3], %3:v[4]"})
        EXPECT_EQ(fused_in_amd(fused), 1u) << fused;
}

TEST(MachineCode, amds_other_instructions_are_not_fused)
{
    for (const char* const other :
         {"v_mul_f32_e32 v1, v2, v3", "v_mad_u32_u24 v1, 3, v2, v3", "v_mad_u64_u32 v[0:1], null, v2, v3, v[4:5]",
          "v_mad_f32 v5, s6, -v4, v5", "v_mac_f32_e32 v4, s25, v3", "v_div_fmas_f32 v1, v2, v3, v4",
          "v_lshl_add_u32 v1, v2, 3, v4", "v_max_f32_e32 v1, v2, v3", "s_load_b128 s[0:3], s[4:5], 0x0"})
        EXPECT_EQ(fused_in_amd(other), 0u) << other;
}

TEST(MachineCode, amds_loads_are_in_loops_between_a_label_and_a_branch_back)
{
    const CodeFigures figures = read_amd("BB0:\n"
                                         "\tbuffer_load_b32 v1, v0, s[0:3], 0 offen\n"
                                         "\ts_cbranch_execz BB3 ; bfa50004\n"
                                         "BB1:\n"
                                         "\tglobal_load_b128 v[0:3], v[4:5], off\n"
                                         "\ts_load_b32 s0, s[2:3], 0x0\n"
                                         "\tscratch_load_b32 v9, off, s0\n"
                                         "\tv_fmac_f32_e32 v1, v2, v3\n"
                                         "\ts_cbranch_scc0 BB1\n"
                                         "BB3:\n"
                                         "\tbuffer_load_b32 v1, v0, s[0:3], 0 offen\n"
                                         "\ts_endpgm\n");
    EXPECT_EQ(figures.loads, 3u);
    EXPECT_EQ(figures.loads_in_loops, 1u);
    EXPECT_EQ(figures.branches, 2u);
    EXPECT_EQ(figures.instructions, 9u);
    EXPECT_EQ(figures.first_fused, "v_fmac_f32_e32 v1, v2, v3");
}

TEST(MachineCode, of_an_entry_of_hips_code_what_divides_is_not_fused)
{
    const auto text_of = [](const std::string& fused) {
        return "other:\n\tv_fma_f32 v1, v2, v3, v4\n.Lfunc_end0:\none:                  ; @one\n; %bb.0:\n"
               "\ts_load_dwordx2 s[0:1], s[4:5], 0x0\n.LBB1_1:      ; =>This Inner Loop Header\n"
               "\tglobal_load_dword v0, v1, s[0:1]\n\tv_div_scale_f32 v2, s[6:7], v0, v0, 1.0\n" +
               fused +
               "\tv_div_fmas_f32 v3, v3, v4, v5\n\ts_cbranch_scc1 .LBB1_1\n\ts_endpgm\n"
               "\t.section .rodata\n.Lfunc_end1:\n\tv_fma_f32 v1, v2, v3, v4\n";
    };
    const std::string division = "\tv_fma_f32 v3, -v2, v4, 1.0\n\tv_fmac_f32_e32 v4, v3, v4\n"
                                 "\tv_fma_f32 v3, -v2, v5, v6\n\tv_fmac_f32_e32 v5, v3, v4\n"
                                 "\tv_fma_f32 v2, -v2, v5, v6\n";
    const CodeFigures one = read_hip(text_of(division), "one");
    EXPECT_EQ(one.fused, 0u);
    EXPECT_EQ(one.first_fused, "");
    EXPECT_EQ(one.divisions, 1u);
    EXPECT_EQ(one.instructions, 11u);
    EXPECT_EQ(one.branches, 1u);
    EXPECT_EQ(one.loads_in_loops, 1u);
    EXPECT_EQ(read_hip(text_of(division + "\tv_pk_fma_f32 v[0:1], v[2:3], v[4:5], v[6:7]\n"), "one").fused, 1u);
    EXPECT_EQ(read_hip(text_of("\tv_dual_fmac_f32 v0, v1, v2 :: v_dual_fmac_f32 v3, v4, v5\n"), "one").fused, 2u);
    EXPECT_EQ(read_hip(text_of("\tv_fma_f32 v3, -v2, v4, 1.0\n"), "one").fused, 1u) << "no such division is known";
}

TEST(MachineCode, ptx_that_is_fused_or_may_be_is_found)
{
    for (const char* const fused :
         {"fma.rn.f32 \t%f1, %f2, %f3, %f4;", "@%p1 fma.rn.ftz.f32 %f1, %f2, %f3, %f4;", "mad.f32 %f1, %f2, %f3, %f4;",
          "add.f32 %f1, %f2, %f3;", "mul.ftz.f32 %f1, %f2, %f3;", "sub.f32 %f1, %f2, %f3;"})
        EXPECT_EQ(fused_in_ptx(fused), 1u) << fused;
    for (const char* const other :
         {"add.rn.f32 \t%f1, %f2, %f3;", "mul.rn.f32 %f1, %f2, %f3;", "mad.lo.s32 %r1, %r2, %r3, %r4;",
          "add.s32 %r1, %r2, %r3;", "div.rn.f32 %f1, %f2, %f3;", "max.f32 %f1, %f2, %f3;"})
        EXPECT_EQ(fused_in_ptx(other), 0u) << other;
}

TEST(MachineCode, ptx_is_read_entry_by_entry)
{
    const std::string text = ".visible .entry one(\n\t.param .u64 one_param_0\n)\n{\n"
                             "$L__BB0_1:\n\tld.global.nc.u32 \t%r1, [%rd1];\n\tfma.rn.f32 %f1, %f2, %f3, %f4;\n"
                             "\t@%p1 bra \t$L__BB0_1;\n\tret;\n}\n"
                             ".visible .entry one_more(\n)\n{\n\tld.global.u32 %r1, [%rd1];\n"
                             "\tld.param.u32 %r2, [p];\n\tdiv.rn.f32 %f1, %f2, %f3;\n\tret;\n}\n";
    const CodeFigures one = read_ptx(text, "one"), more = read_ptx(text, "one_more");
    EXPECT_EQ(one.fused, 1u);
    EXPECT_EQ(one.first_fused, "fma.rn.f32 %f1, %f2, %f3, %f4;");
    EXPECT_EQ(one.loads_in_loops, 1u);
    EXPECT_EQ(one.divisions, 0u);
    EXPECT_EQ(more.fused, 0u);
    EXPECT_EQ(more.loads, 1u);
    EXPECT_EQ(more.loads_in_loops, 0u);
    EXPECT_EQ(more.divisions, 1u);
}

TEST(MachineCode, nvidias_machine_code_is_counted_entry_by_entry)
{
    const std::string text = ".text.one:\n"
                             "        /*0000*/                   LDC R1, c[0x0][0x28] ;\n"
                             ".L_x_1:\n"
                             "        /*0010*/                   LDG.E R2, desc[UR4][R2.64] ;\n"
                             "        /*0020*/                   IMAD R2, R3, R4, R5 ;\n"
                             "        /*0030*/                   FFMA R2, R3, R4, R5 ;\n"
                             "        /*0040*/              @!P0 BRA `(.L_x_1) ;\n"
                             "        /*0050*/                   EXIT ;\n"
                             "//--------------------- .text.two ----\n"
                             ".text.two:\n"
                             "        /*0000*/                   EXIT ;\n";
    const CodeFigures one = read_sass(text, "one");
    EXPECT_EQ(one.instructions, 6u);
    EXPECT_EQ(one.branches, 1u);
    EXPECT_EQ(one.loads_in_loops, 1u);
    EXPECT_EQ(one.fused, 1u) << "a product of whole numbers with a sum is none";
    EXPECT_EQ(read_sass(text, "two").instructions, 1u);
    EXPECT_EQ(read_sass(text, "three").instructions, 0u);
}

TEST(MachineCode, ptxas_words_are_taken_apart_by_entry)
{
    const auto reports = read_ptxas("ptxas info    : 0 bytes gmem\n"
                                    "ptxas info    : Compiling entry function 'a' for 'sm_90'\n"
                                    "ptxas info    : Function properties for a\n"
                                    "    8 bytes stack frame, 62 bytes spill stores, 80 bytes spill loads\n"
                                    "ptxas info    : Used 63 registers, used 0 barriers\n"
                                    "ptxas info    : Compiling entry function 'b' for 'sm_90'\n"
                                    "    0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads\n"
                                    "ptxas info    : Used 40 registers, used 0 barriers, 512 bytes cmem[0]\n");
    ASSERT_EQ(reports.size(), 2u);
    EXPECT_EQ(reports.at("a").registers, 63u);
    EXPECT_EQ(reports.at("a").stack_bytes, 8u);
    EXPECT_EQ(reports.at("a").spill_store_bytes, 62u);
    EXPECT_EQ(reports.at("a").spill_load_bytes, 80u);
    EXPECT_EQ(reports.at("b").registers, 40u);
}

TEST(MachineCode, resident_warps_are_those_of_nvidias_occupancy_calculator)
{
    const auto warps = [](unsigned capability, std::uint64_t registers, std::uint64_t block,
                          std::uint64_t shared_bytes = 0) {
        return resident_warps(capability, registers, block, shared_bytes)->resident;
    };
    EXPECT_EQ(warps(90, 32, 64), 64u);
    EXPECT_EQ(warps(90, 33, 64), 48u) << "40 registers are allocated";
    EXPECT_EQ(warps(90, 64, 64), 32u);
    EXPECT_EQ(warps(90, 255, 128), 8u);
    EXPECT_EQ(warps(75, 64, 64), 32u) << "all that it holds";
    EXPECT_EQ(warps(86, 32, 64), 32u) << "16 blocks of 2 warps, of 48";
    EXPECT_EQ(warps(75, 64, 64, 3072), 32u);
    EXPECT_EQ(warps(75, 64, 64, 8192), 16u) << "8 blocks of 8 KiB, of 64";
    EXPECT_EQ(warps(90, 32, 64, 7168), 56u) << "28 blocks of 7 KiB and 1, of 228";
    EXPECT_FALSE(resident_warps(42, 32, 64, 0));
}

TEST(MachineCode, targets_are_amds_or_nvidias_by_their_names)
{
    EXPECT_EQ(parse_target("--target", "sm_90").maker, Maker::nvidia);
    EXPECT_EQ(parse_target("--target", "gfx1100").maker, Maker::amd);
    EXPECT_EQ(parse_target("--target", "hip:gfx90a").maker, Maker::hip);
    for (const char* const bad : {"", "sm_", "hip:", "hip:GFX90A", "hip:gfx90a:xnack+", "sm_90;", "GFX1100", "../x",
                                  "a b", "abcdefghijklmnopqrstu"})
        EXPECT_THROW(static_cast<void>(parse_target("--target", bad)), Error) << bad;
    EXPECT_EQ(family_names("gfx906"), (std::vector<std::string>{"gfx906", "vega20"}));
    EXPECT_EQ(family_names("navi21"), (std::vector<std::string>{"navi21", "gfx1030"}));
    EXPECT_EQ(targets_of({"sm_90", "sm_90"}).size(), 1u);
}
