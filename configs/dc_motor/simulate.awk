# The recording motor.csv of this study: a simulated DC motor on a bench, made by `awk -f simulate.awk > motor.csv`, with an integrator and a
# pseudo-random generator of its own, by no part of misfit. 30 s at 200 Hz; the voltage steps at random times to random values.
#
#   J w' = K (u - K w) / R - b w - c tanh(w/w0)        Runge-Kutta of fourth order, 50 steps per sample
#   J = 2e-4 kg m^2, K = 0.05 V s/rad, R = 1.2 ohm, b = 1e-4 N m s/rad; dry friction of the bearing c = 0.02 N m (w0 = 0.1 rad/s),
# which is 100 rad/s^2 of deceleration. So damping = (b + K^2/R)/J = 10.9167 1/s and gain = K/(R J) = 208.333 rad/s^2/V.
# Measurement noise of the speed: 0.3 rad/s (1 sigma).

function uniform() {  # Park and Miller's generator, exact in doubles
  state = (16807 * state) % 2147483647
  return state / 2147483647
}
function normal() { return sqrt(-2 * log(uniform())) * cos(6.283185307179586 * uniform()) }
function tanh(x) {
  if (x > 20) return 1
  if (x < -20) return -1
  return (exp(x) - exp(-x)) / (exp(x) + exp(-x))
}
function acceleration(w) { return (K * (u - K * w) / R - b * w - c * tanh(w / w0)) / J }
function step(w, h,    k1, k2, k3, k4) {
  k1 = acceleration(w)
  k2 = acceleration(w + 0.5 * h * k1)
  k3 = acceleration(w + 0.5 * h * k2)
  k4 = acceleration(w + h * k3)
  return w + h * (k1 + 2 * k2 + 2 * k3 + k4) / 6
}

BEGIN {
  J = 2e-4; K = 0.05; R = 1.2; b = 1e-4; c = 0.02; w0 = 0.1
  sample = 0.005; steps = 50; samples = 6000; state = 20261122
  w = 0; u = 0; left = 0
  print "t[s],u[V],w[rad/s]"
  for (k = 0; k < samples; k++) {
    if (left == 0) {
      left = 50 + int(250 * uniform())
      direction = int(3 * uniform()) - 1
      u = sprintf("%.4f", direction * (1 + 11 * uniform())) + 0
    }
    left--
    printf "%.3f,%.4f,%.4f\n", k * sample, u, w + 0.3 * normal()
    for (s = 0; s < steps; s++) w = step(w, sample / steps)
  }
}
