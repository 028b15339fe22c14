#include "misfit/formula/syntax.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "misfit/core/lists.h"
#include "misfit/core/shown.h"

namespace misfit::formula {
namespace {

struct Function {
  const char* name;
  std::size_t least, most;  ///< arguments
};
constexpr std::array<Function, 23> functions = {{{"sqrt", 1, 1},  {"exp", 1, 1},  {"log", 1, 1},        {"log10", 1, 1}, {"sin", 1, 1},
                                                 {"cos", 1, 1},   {"tan", 1, 1},  {"asin", 1, 1},       {"acos", 1, 1},  {"atan", 1, 1},
                                                 {"atan2", 2, 2}, {"sinh", 1, 1}, {"cosh", 1, 1},       {"tanh", 1, 1},  {"abs", 1, 2},
                                                 {"sign", 1, 2},  {"min", 2, 3},  {"max", 2, 3},        {"hypot", 2, 2}, {"saturate", 3, 4},
                                                 {"if", 3, 3},    {"pow", 2, 2},  {"smooth_step", 2, 2}}};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct Token {
  enum class Kind { number, name, sign, end };
  Kind kind = Kind::end;
  std::string text;
  double value = 0.0;
  int begin = 0, end = 0;
};

/// Cuts the text into tokens, the last of kind `end`.
class Lexer {
 public:
  explicit Lexer(const Text& source) : source_(source), text_(source.text) {}

  std::vector<Token> run() {
    std::vector<Token> tokens;
    do {
      while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) ++at_;
      tokens.push_back(next());
    } while (tokens.back().kind != Token::Kind::end);
    return tokens;
  }

 private:
  Token cut(Token::Kind kind, std::size_t length) {
    Token token{kind, std::string(text_.substr(at_, length)), 0.0, static_cast<int>(at_), static_cast<int>(at_ + length)};
    at_ += length;
    return token;
  }

  Token next() {
    if (at_ == text_.size()) return cut(Token::Kind::end, 0);
    const char c = text_[at_];
    if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) return number();
    if (is_letter(c)) {
      std::size_t n = 1;
      while (at_ + n < text_.size() && (is_letter(text_[at_ + n]) || is_digit(text_[at_ + n]))) ++n;
      return cut(Token::Kind::name, n);
    }
    for (const std::string_view sign : {"<=", ">=", "==", "!=", "**"}) {
      if (text_.substr(at_).starts_with(sign)) return cut(Token::Kind::sign, sign.size());
    }
    if (std::string_view("+-*/^(),<>").find(c) != std::string_view::npos) return cut(Token::Kind::sign, 1);
    std::size_t n = 1;  // a whole character of UTF-8
    while (at_ + n < text_.size() && (static_cast<unsigned char>(text_[at_ + n]) & 0xC0U) == 0x80U) ++n;
    source_.fail(static_cast<int>(at_), static_cast<int>(at_ + n), "this character has no meaning in a formula");
  }

  Token number() {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    Token token = cut(Token::Kind::number, end - text_.data() - at_);
    token.value = value;
    if (error != std::errc() || !std::isfinite(value)) source_.fail(token.begin, token.end, "this number is out of range");
    return token;
  }

  const Text& source_;
  std::string_view text_;
  std::size_t at_ = 0;
};

struct Binary {
  const char* text;
  int strength;
};
constexpr std::array<Binary, 13> binaries = {{{"or", 1},
                                              {"and", 2},
                                              {"<", 4},
                                              {"<=", 4},
                                              {">", 4},
                                              {">=", 4},
                                              {"==", 4},
                                              {"!=", 4},
                                              {"+", 5},
                                              {"-", 5},
                                              {"*", 6},
                                              {"/", 6},
                                              {"^", 8}}};
constexpr int strength_of_not = 3, strength_of_sign = 7, strength_of_power = 8;

/// Recursive descent by precedence. Every way down that can repeat goes through `enter`, which counts the depth.
class Parser {
 public:
  explicit Parser(Text source) { out_.source = std::move(source); }

  Syntax run() {
    const auto length = out_.source.text.size();
    if (length > kMaxLength) {
      out_.source.fail(0, 0,
                       "the formula has " + std::to_string(length) + " characters; at most " + std::to_string(kMaxLength) +
                           " are possible: split it with [quantities]");
    }
    tokens_ = Lexer(out_.source).run();
    if (tokens_.size() == 1) out_.source.fail(0, 0, "the formula is empty");
    expression(0);
    if (now().kind != Token::Kind::end) fail_here(now().text == ")" ? "this ')' closes nothing" : "an operator is expected before it");
    return std::move(out_);
  }

 private:
  const Token& now() const { return tokens_[at_]; }
  [[noreturn]] void fail_here(const std::string& message) const {
    if (now().kind == Token::Kind::end) out_.source.fail(now().begin, now().end, message + ", at the end");
    out_.source.fail(now().begin, now().end, message);
  }
  bool take(std::string_view text) {
    if (now().kind == Token::Kind::end || now().kind == Token::Kind::number || now().text != text) return false;
    ++at_;
    return true;
  }
  int last_end() const { return at_ == 0 ? 0 : tokens_[at_ - 1].end; }

  int add(Expression::Kind kind, std::string text, std::vector<int> arguments, int begin, double value = 0.0) {
    out_.nodes.push_back({kind, value, std::move(text), std::move(arguments), begin, last_end()});
    return int_size(out_.nodes) - 1;
  }

  static int strength_of(const Token& token) {
    if (token.kind != Token::Kind::sign && token.kind != Token::Kind::name) return -1;
    for (const Binary& binary : binaries) {
      if (token.text == binary.text) return binary.strength;
    }
    return -1;
  }

  /// Operators at least as strong as `least`.
  int expression(int least) {
    const int begin = now().begin;
    int left = operand();
    for (int strength = strength_of(now()); strength >= least && strength >= 0; strength = strength_of(now())) {
      const std::string op = now().text;
      ++at_;
      const bool power = strength == strength_of_power;
      if (power) enter();
      const int right = expression(power ? strength_of_sign : strength + 1);
      if (power) --depth_;
      if (strength == 4 && strength_of(now()) == 4) fail_here("comparisons cannot be chained: join them with 'and'");
      left = add(Expression::Kind::operation, op, {left, right}, begin);
    }
    if (now().text == "**") fail_here("a power is written '^'");
    return left;
  }

  void enter() {
    if (++depth_ > kMaxDepth)
      fail_here("the formula is nested more than " + std::to_string(kMaxDepth) + " levels deep here: split it with [quantities]");
  }

  int operand() {
    enter();
    const int begin = now().begin;
    int out = 0;
    if (take("-")) {
      const int inner = expression(strength_of_sign);
      out = add(Expression::Kind::operation, "neg", {inner}, begin);
    } else if (take("+")) {
      out = expression(strength_of_sign);
    } else if (take("not")) {
      const int inner = expression(strength_of_not);
      out = add(Expression::Kind::operation, "not", {inner}, begin);
    } else {
      out = primary(begin);
    }
    --depth_;
    return out;
  }

  int primary(int begin) {
    if (take("(")) {
      const int inner = expression(0);
      if (!take(")")) fail_here("')' is expected: a parenthesis is open");
      return inner;
    }
    if (now().kind == Token::Kind::number) {
      const double value = now().value;
      ++at_;
      return add(Expression::Kind::number, "", {}, begin, value);
    }
    if (now().kind != Token::Kind::name || strength_of(now()) >= 0) fail_here("a number, a name or '(' is expected");
    const std::string name = now().text;
    ++at_;
    if (take("(")) return call(name, begin);
    return add(Expression::Kind::name, name, {}, begin);
  }

  int call(const std::string& name, int begin) {
    const int name_end = tokens_[at_ - 2].end;
    const auto* function = std::find_if(functions.begin(), functions.end(), [&](const Function& f) { return name == f.name; });
    if (function == functions.end()) {
      std::vector<std::string> valid;
      for (const Function& f : functions) valid.emplace_back(f.name);
      out_.source.fail(begin, name_end, "there is no function '" + shown(name) + "'" + suggest(name, valid));
    }
    std::vector<int> arguments;
    if (!take(")")) {
      do {
        arguments.push_back(expression(0));
      } while (take(","));
      if (!take(")")) fail_here("',' or ')' is expected");
    }
    if (arguments.size() < function->least || arguments.size() > function->most) {
      const std::string most = function->most > function->least ? " or " + std::to_string(function->most) : "";
      out_.source.fail(begin, last_end(),
                       name + " takes " + std::to_string(function->least) + most + " arguments, not " + std::to_string(arguments.size()));
    }
    return add(Expression::Kind::call, name, std::move(arguments), begin);
  }

  Syntax out_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

void Text::fail(int begin, int end, const std::string& message) const {
  Source place = where;
  if (place.column > 0 && text.find('\n') == std::string::npos) place.column += begin;
  constexpr std::size_t longest = 60;
  const auto shortened = [](const std::string& part) { return part.size() > longest ? part.substr(0, longest - 3) + "..." : part; };
  const std::string part = shortened(text.substr(begin, std::max(end - begin, 0)));
  throw InputError(place, of + (part.empty() ? "" : ", '" + shown(part) + "'") + ": " + message);
}

Syntax parse(Text source) { return Parser(std::move(source)).run(); }

const std::vector<std::string>& reserved_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out{"pi", "t", "and", "or", "not"};
    for (const Function& f : functions) out.emplace_back(f.name);
    return out;
  }();
  return names;
}

bool is_name(std::string_view text) {
  if (text.empty() || !is_letter(text.front())) return false;
  if (!std::all_of(text.begin(), text.end(), [](char c) { return is_letter(c) || is_digit(c); })) return false;
  const auto& reserved = reserved_names();
  return std::find(reserved.begin(), reserved.end(), text) == reserved.end();
}

}  // namespace misfit::formula
