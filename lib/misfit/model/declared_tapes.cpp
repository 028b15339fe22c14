#include "misfit/core/lists.h"
#include "misfit/model/declared_system.h"

namespace misfit::declared {
namespace {

class Tapes {
 public:
  enum Wanted : unsigned { by_x = 1, by_F = 2, by_k = 4, by_P = 8, steepest = 16 };
  Tapes(Compiled& compiled, const Source& where) : c_(compiled), where_(where) {}

  Tape one(const std::vector<int>& nodes, unsigned wanted) {
    const Leaves& n = c_.leaves;
    std::vector<int> roots = nodes;
    std::vector<std::pair<std::vector<Tape::Entry>*, Tape::Entry>> entries;
    Tape out;
    for (int row = 0; row < int_size(nodes); ++row) out.value.push_back({row, row});
    struct Block {
      unsigned flag;
      int first, count;
      std::vector<Tape::Entry>* into;
    };
    for (const Block& block : {Block{by_x, n.x(0), n.nx, &out.by_x}, Block{by_F, n.F(0), n.nf, &out.by_F},
                               Block{by_k, n.k(0), n.nk, &out.by_k}, Block{by_P, n.P(0), n.np, &out.by_P}}) {
      if ((wanted & block.flag) == 0U) continue;
      std::vector<int> leaves;
      for (int i = 0; i < block.count; ++i) leaves.push_back(c_.graph.leaf(block.first + i));
      for (int row = 0; row < int_size(nodes); ++row) {
        const std::vector<int> slopes = c_.graph.derivatives(nodes[row], leaves, (wanted & steepest) != 0U);
        for (int i = 0; i < int_size(slopes); ++i) {
          if (c_.graph.is(slopes[i], 0.0)) continue;
          block.into->push_back({row * block.count + i, int_size(roots)});
          roots.push_back(slopes[i]);
        }
      }
    }
    try {
      out.program = formula::Program(c_.graph, roots, n.count());
    } catch (const InputError& error) {
      throw InputError(where_, error.what());
    }
    for (auto* list : {&out.value, &out.by_x, &out.by_F, &out.by_k, &out.by_P}) {
      for (auto& entry : *list) entry.from = out.program.place(entry.from);
    }
    return out;
  }

 private:
  Compiled& c_;
  const Source& where_;
};

}  // namespace

void make_tapes(Compiled& c, const std::vector<int>& quantities, const std::vector<int>& outputs, const Source& where) {
  Tapes tapes(c, where);
  c.rates = tapes.one(c.rate_nodes, 0U);
  c.rates_x = tapes.one(c.rate_nodes, Tapes::by_x | Tapes::by_F);
  c.rates_k = tapes.one(c.rate_nodes, Tapes::by_x | Tapes::by_F | Tapes::by_k);
  c.rates_all = tapes.one(c.rate_nodes, Tapes::by_x | Tapes::by_F | Tapes::by_k | Tapes::by_P);
  c.rates_steep = tapes.one(c.rate_nodes, Tapes::by_x | Tapes::steepest);
  c.quantities = tapes.one(quantities, 0U);
  c.quantities_x = tapes.one(quantities, Tapes::by_x);
  c.quantities_k = tapes.one(quantities, Tapes::by_x | Tapes::by_k);
  c.quantities_all = tapes.one(quantities, Tapes::by_x | Tapes::by_k | Tapes::by_P);
  c.outputs = tapes.one(outputs, 0U);
  c.outputs_x = tapes.one(outputs, Tapes::by_x);
  c.outputs_k = tapes.one(outputs, Tapes::by_x | Tapes::by_k);
  c.outputs_all = tapes.one(outputs, Tapes::by_x | Tapes::by_k | Tapes::by_P);
}

}  // namespace misfit::declared
