#include "explain/traced.h"

#include "illumination/fresnel.h"

namespace lambent {
namespace {

thread_local Formulas* living = nullptr;

}  // namespace

Formulas::Formulas() : before_(living) {
  living = this;
  add({Operation::number, 0, -1, -1, true, "", -1});
}
Formulas::~Formulas() { living = before_; }
Formulas& Formulas::current() { return *living; }

int Formulas::add(FormulaNode node) {
  nodes.push_back(std::move(node));
  return int(nodes.size()) - 1;
}

std::string Formulas::vector_name(int x, int y, int z) const {
  if (x < 0 || y < 0 || z < 0) return "";
  const FormulaNode &nx = nodes[std::size_t(x)], &ny = nodes[std::size_t(y)], &nz = nodes[std::size_t(z)];
  if (nx.operation != ny.operation || nx.operation != nz.operation) return "";
  const auto firsts = [&] { return vector_name(nx.a, ny.a, nz.a); };
  const auto seconds = [&] { return vector_name(nx.b, ny.b, nz.b); };
  switch (nx.operation) {
    case Operation::symbol:
      return nx.name == ny.name && nx.name == nz.name && nx.axis == 0 && ny.axis == 1 && nz.axis == 2
                 ? nx.name
                 : "";
    case Operation::add:
    case Operation::subtract: {
      const std::string a = firsts(), b = seconds();
      if (a.empty() || b.empty()) return "";
      return "(" + a + (nx.operation == Operation::add ? " + " : " - ") + b + ")";
    }
    case Operation::negate: {
      const std::string a = firsts();
      return a.empty() ? "" : "(-" + a + ")";
    }
    case Operation::multiply: {
      const std::string v = seconds();
      if (v.empty() || nx.a < 0) return "";
      const FormulaNode& factor = nodes[std::size_t(nx.a)];
      return factor.operation == Operation::number && factor.value == 0.5 ? "(" + v + " / 2)" : "";
    }
    default:
      return "";
  }
}

Traced sqrt(const Traced& a) {
  const std::string name = Formulas::current().nodes[std::size_t(a.node)].name;
  constexpr std::string_view squared = "^2";
  if (name.size() > squared.size() && name.front() == '|' && name.ends_with(squared))
    return Traced::symbol(name.substr(0, name.size() - squared.size()), sqrt(a.value));
  return {Operation::root, sqrt(a.value), a};
}

Traced fresnel_conductor(const Traced& cosine, const Traced& eta, const Traced& k) {
  return Traced::symbol("w", fresnel_conductor(cosine.value, eta.value, k.value));
}

Vec3<Traced> vector_symbol(const std::string& name, const Vec3<double>& value) {
  return {Traced::symbol(name, value.x, 0), Traced::symbol(name, value.y, 1),
          Traced::symbol(name, value.z, 2)};
}

Traced dot(const Vec3<Traced>& a, const Vec3<Traced>& b) {
  const Formulas& formulas = Formulas::current();
  const std::string first = formulas.vector_name(a.x.node, a.y.node, a.z.node),
                    second = formulas.vector_name(b.x.node, b.y.node, b.z.node);
  if (first.empty() || second.empty()) return a.x * b.x + a.y * b.y + a.z * b.z;
  const auto bare = [](const std::string& name) {
    return name.front() == '(' ? name.substr(1, name.size() - 2) : name;
  };
  return Traced::symbol(first == second ? "|" + bare(first) + "|^2" : first + "." + second,
                        dot(values(a), values(b)));
}

Vec3<Traced> reflect(const Vec3<Traced>& L, const Vec3<Traced>& N) {
  Formulas& formulas = Formulas::current();
  const std::string of = formulas.vector_name(L.x.node, L.y.node, L.z.node),
                    about = formulas.vector_name(N.x.node, N.y.node, N.z.node);
  if (of.empty() || about.empty()) return Traced(2) * dot(N, L) * N - L;
  const std::string name = of == "L" ? "R" : "R" + of;
  const Vec3<double> value = reflect(values(L), values(N));
  formulas.definitions.push_back({name, "2 (" + about + "." + of + ") " + about + " - " + of, value});
  return vector_symbol(name, value);
}

Vec3<Traced> normalize(const Vec3<Traced>& a) {
  Formulas& formulas = Formulas::current();
  const std::string of = formulas.vector_name(a.x.node, a.y.node, a.z.node);
  if (of.empty()) return (Traced(1) / sqrt(dot(a, a))) * a;
  const Vec3<double> value = normalize(values(a));
  const std::string bare = of.front() == '(' ? of.substr(1, of.size() - 2) : of;
  const std::string name = of == "(L + V)" ? "H" : of + "'";
  formulas.definitions.push_back({name, of + " / |" + bare + "|", value});
  return vector_symbol(name, value);
}

Color<Traced> color_symbol(const std::string& name, const Rgb& value) {
  Color<Traced> result;
  for (int i = 0; i < color_channels; ++i) result[i] = Traced::symbol(name, value[i]);
  return result;
}

}  // namespace lambent
